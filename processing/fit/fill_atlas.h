// From per-lumitexel results to the atlas's maps.
#pragma once

#include <vector>

#include "processing/brdf/project_weights.h"
#include "processing/model/model.h"
#include "processing/surface/atlas.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

// Fills model.width … model.samples from the lumitexels (label and weights per lumitexel, in the set's order; projection: the weights
// before principal function analysis, empty where that did not run).
// Lumitexels' normals are kept. Texels without samples of their own, around patches and inside them, take material and weights from the nearest
// texel that has some, their sample count is zero. Beside all lumitexels the normal is zero, too (the renderer uses the mesh's); where normals were fitted
// (model.before_normals) the two texels next to a patch, which look-ups at its border blend in, have their neighbour's. Triangles that no view saw take
// the largest material.
void fill_atlas(const Atlas& atlas, const LumitexelSet& lumitexels, const std::vector<int>& label,
                const std::vector<TexelWeights>& weights, const std::vector<TexelWeights>& projection, Model& model);

// Grows every patch by one texel a round, up to 64: texels without a material take material and weights of a neighbour. rim: the texels that have one.
void fill_holes(Model& model, std::vector<std::size_t> rim);

// Pairs of horizontally or vertically adjacent texels of materials a and b: [a][b], symmetric.
std::vector<std::vector<std::size_t>> neighbour_counts(const Atlas& atlas, const LumitexelSet& lumitexels,
                                                       const std::vector<int>& label, std::size_t materials);

}  // namespace lumitexel
