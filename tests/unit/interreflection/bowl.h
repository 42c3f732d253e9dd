// Half of a unit sphere, open towards +z, lit straight from above: light between its surfaces has a closed form.
//
// Any two pieces of a sphere exchange light by their areas alone, so inside an evenly matte bowl every point receives the same: of a
// lamp's light E by way of one other surface albedo * E / 4, and each further bounce albedo / 2 of the one before.
#pragma once

#include "processing/surface/lumitexel.h"
#include "processing/surface/ray_scene.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {

inline Mesh bowl_mesh(int around = 96, int upwards = 96) {
  Mesh mesh = sphere_mesh(around, upwards);
  for (Eigen::Vector3d& normal : mesh.normals) normal = -normal;
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    double middle = 0.0;
    for (const std::uint32_t corner : triangle) middle += mesh.positions[corner].z();
    return middle > 0.0;
  });
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// Of the lamp's light, after so many bounces and with the surface's own last reflection left out.
inline double bowl_indirect_share(double albedo, int bounces) {
  double share = 0.0, bounce = albedo / 4.0;
  for (int i = 0; i < bounces; ++i, bounce *= albedo / 2.0) share += bounce;
  return share;
}

inline View bowl_view() {
  View view = view_from_above(200, 5.0);
  view.light.intensity = {2.0, 2.0, 2.0};
  return view;
}

// Lumitexels inside the bowl, one sample each, of the reflectance r as photographed after so many bounces.
inline LumitexelSet bowl_lumitexels(double albedo, int bounces) {
  const Mesh mesh = bowl_mesh();
  const RayScene scene(mesh);
  LumitexelSet set;
  set.channels = 3;
  set.tiles.emplace_back();
  LumitexelTile& tile = set.tiles.back();
  for (int j = 1; j <= 8; ++j) {
    for (int i = 0; i < 8; ++i) {
      const double polar = 0.5 * std::numbers::pi * (0.9 * j / 8.0), turn = 2.0 * std::numbers::pi * (i + 0.3) / 8;
      const Eigen::Vector3d outward(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), -std::cos(polar));
      tile.position.push_back(scene.closest(Eigen::Vector3d::Zero(), outward)->distance_m * outward);
      tile.normal.push_back(-outward);
      tile.texel.push_back(static_cast<std::uint32_t>(tile.texel.size()));
      tile.view.push_back(0);
      for (int c = 0; c < 3; ++c) {
        tile.reflectance.push_back(static_cast<float>(albedo / std::numbers::pi * (std::cos(polar) + bowl_indirect_share(albedo, bounces))));
        tile.variance.push_back(0.0f);
      }
      tile.first_sample.push_back(static_cast<std::uint32_t>(tile.samples()));
    }
  }
  return set;
}

}  // namespace lumitexel
