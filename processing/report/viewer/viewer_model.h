// A model as the viewer's page carries it: numbers that a person might read as JSON, maps and mesh as chunks.
//
// What is lost on the way: weights, uncertainty and residuals are half floats (relative 5e-4 at most), normals octahedral on 16 bits
// each (3e-5 rad), the mesh single precision about the middle of its box. Maps hold only texels with a material, in raster order.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "processing/model/model.h"
#include "processing/report/viewer/packed_chunks.h"

namespace lumitexel {

// Of its vertices, m; the page's numbers are about its centre.
struct MeshBox {
  Eigen::Vector3d low, high;
  Eigen::Vector3d centre() const { return 0.5 * (low + high); }
};
MeshBox box_of(const Mesh& mesh);

// Atlas indices y * width + x of the texels with a material.
std::vector<std::uint32_t> textured_texels(const Model& model);

// "channels", "atlas", "centre" (m, of the mesh's box), "box" ("low" about the centre, "size"), "diagonal_m", "single", "indirect_bounces" (Model's), and
// viewer_layers.h's "layers" and "stages".
nlohmann::json viewer_model_json(const Model& model);
// "positions", "normals", "texcoords", "triangles_low" and "_high" (of 32 bits), "textured" (by the atlas: 1 in textured_texels), those
// of viewer_layers.h, "texel_normals", "sigma", "samples", and where normals were fitted "normal_sigma"; "indirect" (the share
// that was found) where light between surfaces was looked for.
void add_model_chunks(const Model& model, PackedChunks& chunks);

// A map's values at the texels as half floats, a plane a channel.
std::vector<std::uint16_t> halves_of(const Image& map, const std::vector<std::uint32_t>& texels);

// A unit vector's two octahedral coordinates, 0 … 65534; kNoOctahedral twice for a zero vector.
inline constexpr std::uint16_t kNoOctahedral = 65535;
std::array<std::uint16_t, 2> octahedral(const Eigen::Vector3d& unit);
Eigen::Vector3d from_octahedral(const std::array<std::uint16_t, 2>& code);

}  // namespace lumitexel
