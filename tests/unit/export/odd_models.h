// Models whose exports are less usual: highlights that differ from texel to texel, and surface that nobody saw.
#pragma once

#include "tests/unit/plain_models.h"

namespace lumitexel {

// Two materials, matte and glossy with a lobe a channel, whose share grows along u.
inline Model glossy_model() {
  Model model = with_own_normals(model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05)));
  const Brdf glossy = with_ggx_lobe(diffuse_brdf(0.05, 0.08, 0.02), 0.6, 0.15);
  model.materials.push_back({glossy, {glossy}, {}});
  for (std::size_t t = 0; t < model.material.size(); ++t) {
    model.material[t] = t % 16 >= 8;
    model.weights.data[t] = 0.1f * static_cast<float>(t % 16);
  }
  return model;
}

// As fits leave surface that no photograph shows, in an atlas cut from photographs: its triangles have no area in the texture and look up texel (0, 0),
// which has no samples; texels between the charts have no material.
inline Model partly_unseen_model() {
  Model model = glossy_model();
  Mesh& mesh = model.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    for (std::uint32_t& vertex : mesh.triangles[t]) {
      mesh.positions.push_back(mesh.positions[vertex]);
      mesh.normals.push_back(mesh.normals[vertex]);
      mesh.texcoords.emplace_back(0.5 / model.width, 1.0 - 0.5 / model.height);
      vertex = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
  }
  for (int x = 0; x < model.width; ++x) model.material[static_cast<std::size_t>(3 * model.width + x)] = Model::kNoMaterial;
  model.samples.at(0, 0) = 0.0f;
  for (int k = 0; k < 3; ++k) model.normal.at(0, 0, k) = 0.0f;
  return model;
}

}  // namespace lumitexel
