// Where light between an object's surfaces can matter at all: an estimate from above, from what each point faces and how much that reflects. It
// costs some rays a vertex; a convex object gets zero everywhere.
//
// No strict bound: 64 directions a vertex miss what fills a thirtieth of its view about once in eight times, between vertices nobody looks, and
// albedos are the clusters', not the texels' own. Paths (indirect_light.h) then say what there is.
#pragma once

#include "processing/model/model.h"
#include "processing/surface/lumitexel.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

// Of each triangle: the share of light that its material reflects at 45 degrees, in the channel where that is most; 0 where it has no
// material, 0.95 where a fitted BRDF has more than any surface can.
std::vector<float> triangle_albedos(const Model& model);

// Of each lumitexel: the most that other surfaces can send to it, as a share of the light that a lamp sends to a surface that
// squarely faces it: A / (1 - A'), with A what the point faces, weighted by its albedo, and A' the largest A of all (every bounce as bright
// as can be). mesh: the model's, or one with the same triangles.
std::vector<float> indirect_bounds(const LumitexelSet& lumitexels, const Mesh& mesh, const RayScene& scene,
                                   const std::vector<float>& triangle_albedo);

}  // namespace lumitexel
