#include "tests/unit/light/light_bound.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

namespace lumitexel {
namespace {

SphereLine moved_line(const SphereLine& line, const Eigen::VectorXd& p) {
  SphereLine moved = line;
  const Eigen::Vector3d across = line.direction.unitOrthogonal();
  moved.first_centre += p.head<3>();
  moved.direction = (line.direction + p[3] * across + p[4] * line.direction.cross(across)).normalized();
  return moved;
}

// All coordinates, rings first.
Eigen::VectorXd places(const SphereRig& rig, const Eigen::VectorXd& p) {
  const SphereLine line = moved_line(rig.line, p);
  std::vector<double> all;
  const auto add = [&](const Eigen::Vector2d& pixel) { all.insert(all.end(), {pixel.x(), pixel.y()}); };
  for (int k = 0; k < line.count; ++k) add(ring_highlight_pixel(rig.camera, line.sphere(k), rig.ring_radius_m));
  for (std::size_t v = 0; v < rig.lights.size(); ++v) {
    const Eigen::Vector3d light = rig.lights[v] + p.segment<3>(5 + 3 * static_cast<Eigen::Index>(v));
    for (int k = 0; k < line.count; ++k) add(highlight_pixel(rig.camera, line.sphere(k), light));
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

}  // namespace

SphereRig simulated_sphere_rig(int scale) {
  SphereRig rig;
  rig.camera = {1024 * scale, 768 * scale, 2950.0 * scale, 2950.0 * scale, 516.3 * scale, 379.8 * scale, -0.08, 0.15, 0.0004,
                -0.0003};
  rig.line.direction = Eigen::Vector3d(0.98, 0.03, 0.2).normalized();
  rig.line.first_centre = Eigen::Vector3d(0.0, -0.09, 1.05) - 2.5 * 0.05 * rig.line.direction;
  rig.line.spacing_m = 0.05;
  rig.line.radius_m = 0.02;
  rig.line.count = 6;
  rig.lights = {{0.8, -0.5, 0.6}, {-0.9, -0.3, 0.4}, {0.1, -1.0, 0.5}, {0.3, -0.4, -0.2}};
  return rig;
}

RigHighlights noisy_highlights(const SphereRig& rig, double sigma_px, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, sigma_px);
  const Eigen::VectorXd exact = places(rig, Eigen::VectorXd::Zero(5 + 3 * static_cast<Eigen::Index>(rig.lights.size())));
  RigHighlights seen;
  Eigen::Index next = 0;
  const auto take = [&](int sphere) {
    HighlightPixel h{sphere, {exact[next], exact[next + 1]}, sigma_px > 0.0 ? sigma_px : 1e-3};
    if (sigma_px > 0.0) h.pixel += Eigen::Vector2d(noise(random), noise(random));
    next += 2;
    return h;
  };
  for (int k = 0; k < rig.line.count; ++k) seen.rings.push_back(take(k));
  for (std::size_t v = 0; v < rig.lights.size(); ++v) {
    seen.points.emplace_back();
    for (int k = 0; k < rig.line.count; ++k) seen.points.back().push_back(take(k));
  }
  return seen;
}

std::vector<Eigen::Matrix3d> position_bounds(const SphereRig& rig, double sigma_px) {
  const Eigen::Index n = 5 + 3 * static_cast<Eigen::Index>(rig.lights.size());
  Eigen::MatrixXd j(places(rig, Eigen::VectorXd::Zero(n)).size(), n);
  constexpr double kStep = 1e-5;  // m and rad
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(n, k);
    j.col(k) = (places(rig, step) - places(rig, -step)) / (2.0 * kStep);
  }
  const Eigen::MatrixXd covariance = (j.transpose() * j).inverse() * sigma_px * sigma_px;
  std::vector<Eigen::Matrix3d> bounds;
  for (std::size_t v = 0; v < rig.lights.size(); ++v) {
    const auto k = 5 + 3 * static_cast<Eigen::Index>(v);
    bounds.push_back(covariance.block<3, 3>(k, k));
  }
  return bounds;
}

LightSolution solved_lights(const SphereRig& rig, const RigHighlights& seen) {
  std::vector<Eigen::Vector3d> rays;
  for (const HighlightPixel& ring : seen.rings) rays.push_back(rig.camera.unproject(ring.pixel));
  const SphereLine start = sphere_line_from_rays(rays, rig.line.spacing_m, rig.line.radius_m);
  return solve_lights(rig.camera, start, rig.ring_radius_m, seen.rings, seen.points);
}

}  // namespace lumitexel
