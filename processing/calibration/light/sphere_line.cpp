#include "processing/calibration/light/sphere_line.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Rays = std::vector<Eigen::Vector3d>;

int largest_component(const Rays& rays) {
  Eigen::Index largest = 0;
  rays.front().cross(rays.back()).cwiseAbs().maxCoeff(&largest);
  return static_cast<int>(largest);
}

// The relations in units of lambda_0: two per inner ray, unknowns lambda_1 … lambda_(n-1). Between spheres of the places a, b, c
// it is (c - b) c_a - (c - a) c_b + (b - a) c_c = 0.
Eigen::VectorXd relative_depths(const Rays& rays, const std::vector<int>& places) {
  const auto n = static_cast<Eigen::Index>(rays.size());
  const int k = largest_component(rays);
  const auto cross = [&](Eigen::Index a, Eigen::Index b) {
    return rays[static_cast<std::size_t>(a)].cross(rays[static_cast<std::size_t>(b)])[k];
  };
  Eigen::MatrixXd relations = Eigen::MatrixXd::Zero(2 * (n - 2), n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const auto j = static_cast<std::size_t>(i);
    const double before = places[j] - places[j - 1], after = places[j + 1] - places[j];
    relations(2 * i - 2, i - 1) = after * cross(i - 1, i);
    relations(2 * i - 2, i + 1) = before * cross(i + 1, i);
    relations(2 * i - 1, i + 1) = before * cross(i + 1, i - 1);
    relations(2 * i - 1, i) = -(before + after) * cross(i, i - 1);
  }
  Eigen::VectorXd depths(n);
  depths[0] = 1.0;
  depths.tail(n - 1) = relations.rightCols(n - 1).colPivHouseholderQr().solve(-relations.col(0));
  return depths;
}

}  // namespace

SphereLine sphere_line_from_rays(const Rays& rays, double spacing_m, double radius_m) {
  std::vector<int> places(rays.size());
  std::iota(places.begin(), places.end(), 0);
  return sphere_line_from_rays(rays, places, spacing_m, radius_m);
}

SphereLine sphere_line_from_rays(const Rays& rays, const std::vector<int>& places, double spacing_m, double radius_m) {
  if (rays.size() < 3) throw BadInput("sphere line", std::to_string(rays.size()) + " rays", "at least three");
  if (places.size() != rays.size() || places.front() < 0 ||
      std::adjacent_find(places.begin(), places.end(), std::greater_equal<>()) != places.end()) {
    throw BadInput("sphere line", "places that do not ascend, one a ray", "0, 1, 2, … as far as seen");
  }
  const Eigen::VectorXd depths = relative_depths(rays, places);
  if (!depths.allFinite() || depths.minCoeff() <= 0.0) {
    throw BadInput("sphere line", "rays that no line in front of the camera fits",
                   "rays towards distinct spheres in order");
  }
  // A straight line through the centres by least squares over their place; its slope is one spacing.
  const double n = static_cast<double>(rays.size());
  const double middle = std::accumulate(places.begin(), places.end(), 0.0) / n;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
  double spread = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double t = places[i] - middle;
    const Eigen::Vector3d centre = depths[static_cast<Eigen::Index>(i)] * rays[i];
    mean += centre / n;
    slope += t * centre;
    spread += t * t;
  }
  slope /= spread;
  const double scale = spacing_m / slope.norm();
  if (!std::isfinite(scale)) throw BadInput("sphere line", "rays that coincide", "rays towards distinct spheres");
  SphereLine line;
  line.direction = slope.normalized();
  line.first_centre = scale * (mean - middle * slope);
  line.spacing_m = spacing_m;
  line.radius_m = radius_m;
  line.count = places.back() + 1;
  return line;
}

}  // namespace lumitexel
