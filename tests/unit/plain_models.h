// Small models whose appearance has a closed form.
#pragma once

#include <cmath>
#include <numbers>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"

namespace lumitexel {

inline Brdf diffuse_brdf(double red, double green, double blue) {
  Brdf brdf;
  brdf.diffuse = {red, green, blue};
  return brdf;
}

// The diffuse part with one GGX lobe, the same in three channels.
inline Brdf with_ggx_lobe(Brdf brdf, double f0, double alpha) {
  brdf.family = BrdfFamily::Ggx;
  Lobe lobe;
  lobe.log_strength = std::log(f0);
  lobe.log_shape = 2.0 * std::log(alpha);
  brdf.lobes.push_back({lobe, lobe, lobe});
  return brdf;
}

// Maps of the given size: every texel of material 0, without normals (so the mesh's are used), one basis of weight 1.
inline Model model_of(Mesh mesh, int width, int height, const Brdf& brdf) {
  Model model;
  model.mesh = std::move(mesh);
  model.width = width;
  model.height = height;
  model.single = brdf;
  model.materials = {{brdf, {brdf}}};
  model.material.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  model.weights = Image(width, height, 1, 1.0f);
  model.normal = Image(width, height, 3);
  model.uncertainty = Image(width, height, 1, 0.25f);
  model.samples = Image(width, height, 1, 7.0f);
  model.provenance_json = R"({"session_key": "bench", "rms": {"single": 0.1, "cluster": 0.05, "projection": 0.025}})";
  return model;
}

// [-1, 1] x [-1, 1] at z = 0, facing +z, u along x and v along y.
inline Mesh square_mesh() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.normals.assign(4, Eigen::Vector3d::UnitZ());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// The unit sphere about the origin, u along the longitude (with a doubled seam), v along the latitude; exact normals.
inline Mesh sphere_mesh(int around, int upwards) {
  Mesh mesh;
  for (int j = 0; j <= upwards; ++j) {
    for (int i = 0; i <= around; ++i) {
      const double u = static_cast<double>(i) / around, v = static_cast<double>(j) / upwards;
      const double longitude = 2.0 * std::numbers::pi * u, latitude = std::numbers::pi * (v - 0.5);
      const Eigen::Vector3d point(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                                  std::sin(latitude));
      mesh.positions.push_back(point);
      mesh.normals.push_back(point.normalized());
      mesh.texcoords.emplace_back(u, v);
    }
  }
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * (around + 1) + i); };
  for (int j = 0; j < upwards; ++j) {
    for (int i = 0; i < around; ++i) {
      if (j > 0) mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      if (j + 1 < upwards) mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  return mesh;
}

// Every texel with a normal of its own, along +x.
inline Model with_own_normals(Model model) {
  for (std::size_t t = 0; t < model.normal.data.size(); ++t) model.normal.data[t] = t % 3 == 0 ? 1.0f : 0.0f;
  return model;
}

// From (0, 0, distance) straight down to the origin, the world's +x to the right and +y up; the square fills the
// picture exactly.
inline View view_from_above(int size_px, double distance_m) {
  View view;
  view.name = "above";
  const double focal_px = 0.5 * size_px * distance_m;
  view.camera = {size_px, size_px, focal_px, focal_px, 0.5 * size_px, 0.5 * size_px};
  view.camera_from_world.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  view.camera_from_world.translation() = Eigen::Vector3d(0, 0, distance_m);
  view.light.type = Light::Type::Directional;
  view.light.vector_in_world = Eigen::Vector3d::UnitZ();
  view.light.intensity = {1, 1, 1};
  return view;
}

}  // namespace lumitexel
