// The maps of a model's atlas as EXR files, one texel a pixel, all of one size:
//
//   cluster.exr       Y, uint: the texel's material, 65535 where there is none
//   weights_0.exr, …  R,G,B,A: weights 4k to 4k+3 of the basis of the texel's material; zero past the last
//   projection_weights_0.exr, …  the same before principal function analysis, if that ran
//   normal.exr        R,G,B: unit, in world; zero where there is none
//   before_normals_cluster.exr, before_normals_weights_0.exr, …  the stages before normals were fitted, if they were
//   normal_sigma.exr  Y: one sigma of the fitted normal per tangent axis, radians, if normals were fitted
//   indirect_bound.exr, indirect_share.exr  Y: Model::indirect, if it was looked for
//   uncertainty.exr   Y: one sigma of the texel's reflectance, relative
//   samples.exr       Y: how many samples the texel was fitted to
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "processing/model/model.h"

namespace lumitexel {

struct AtlasMap {
  std::string file;
  std::vector<std::string> channels;
};

// How large the bases of a layer's materials are at most, and whether it remembers them before principal function analysis.
struct LayerShape {
  int basis_size = 0;
  bool principal_functions = false;
};

struct MapsShape {
  LayerShape layer;
  std::optional<LayerShape> before_normals;  // nothing where normals were not fitted
  bool indirect = false;                     // whether light between surfaces was looked for
};

// What a model of this shape consists of.
std::vector<AtlasMap> atlas_maps(const MapsShape& shape);

void write_atlas_maps(const std::filesystem::path& directory, const Model& model);  // throws Error

// Fills the maps of `model`, whose size and materials are known, those of before_normals too if it is there. Throws BadInput naming the file and the texel for a
// map that is missing, of another size, not finite, negative (all but normals), or a material or normal that cannot be.
void read_atlas_maps(const std::filesystem::path& directory, const MapsShape& shape, Model& model);

}  // namespace lumitexel
