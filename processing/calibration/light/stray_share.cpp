#include "processing/calibration/light/stray_share.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

// What every highlight's flux has in common: the profile's tails beyond the fitted window, the mirror's reflectance growing
// towards the rim. Rendered spheres of rough metal scatter by less.
constexpr double kCommonError = 0.02;
constexpr double kMedianOverMean = 1.25;  // standard deviation of a median over that of a mean
// A light that is not placed stands at least this many lengths of the line of spheres away; beyond the second nothing changes.
constexpr double kNearestLines = 10.0, kFarLines = 1000.0;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double squared_distance(const SphereLine& line, int sphere, const Eigen::Vector3d& light) {
  return (light - mirror_point(line.sphere(sphere), Eigen::Vector3d::Zero(), light)).squaredNorm();
}

double irradiance(const LitPlace& place, const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_light = light - place.position;
  const double square = to_light.squaredNorm();
  return std::max(0.0, to_light.dot(place.normal)) / (square * std::sqrt(square));
}

struct ShareModel {
  const StrayLight& stray;
  const SphereLine& line;
  const std::vector<std::optional<Strength>>& lamp;
  const LitPlace& place;
  double lamp_irradiance;

  Strength at(const Eigen::Vector3d& position) const {
    Strength share = stray_ratio(stray, position, line, lamp)->value;
    for (double& value : share) value *= irradiance(place, position) / lamp_irradiance;
    return share;
  }

  // Standard deviation of the share by the position's covariance: half the difference over both ends of each principal axis.
  Strength by_position(const Eigen::Matrix3d& covariance) const {
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    Strength square{};
    for (int axis = 0; axis < 3; ++axis) {
      const Strength up = at(stray.position + root.col(axis)), down = at(stray.position - root.col(axis));
      for (std::size_t c = 0; c < 3; ++c) square[c] += 0.25 * (up[c] - down[c]) * (up[c] - down[c]);
    }
    return {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2])};
  }
};

}  // namespace

std::vector<std::optional<Strength>> lamp_strengths(const SphereHighlights& seen, const LightSolution& lights) {
  std::vector<std::optional<Strength>> strengths;
  for (int k = 0; k < lights.line.count; ++k) {
    std::array<std::vector<double>, 3> values;
    for (std::size_t v = 0; v < seen.points.size(); ++v) {
      if (!lights.lights[v].measured) continue;
      for (const HighlightPixel& point : seen.points[v]) {
        if (point.sphere != k || !(point.flux[1] > 0.0)) continue;
        const double square = squared_distance(lights.line, k, lights.lights[v].position);
        for (std::size_t c = 0; c < 3; ++c) values[c].push_back(point.flux[c] * square);
      }
    }
    std::optional<Strength>& strength = strengths.emplace_back();
    if (!values[0].empty()) strength = {median(values[0]), median(values[1]), median(values[2])};
  }
  return strengths;
}

std::optional<StrayRatio> stray_ratio(const StrayLight& stray, const Eigen::Vector3d& position, const SphereLine& line,
                                      const std::vector<std::optional<Strength>>& lamp) {
  std::array<std::vector<double>, 3> ratios;
  for (const HighlightPixel& seen : stray.highlights) {
    const auto& strength = lamp[static_cast<std::size_t>(seen.sphere)];
    if (!strength || !(seen.flux[1] > 0.0)) continue;
    const double square = squared_distance(line, seen.sphere, position);
    for (std::size_t c = 0; c < 3; ++c) ratios[c].push_back(seen.flux[c] * square / (*strength)[c]);
  }
  if (ratios[0].empty()) return std::nullopt;
  StrayRatio ratio;
  for (std::size_t c = 0; c < 3; ++c) {
    ratio.value[c] = median(ratios[c]);
    std::vector<double> off;
    for (const double value : ratios[c]) off.push_back(std::abs(value / ratio.value[c] - 1.0));
    const double scatter = kMedianOverMean * 1.4826 * median(off) / std::sqrt(static_cast<double>(off.size()));
    ratio.relative_sigma = std::max(ratio.relative_sigma, std::hypot(kCommonError, scatter));
  }
  return ratio;
}

std::optional<StrayShare> stray_share(const StrayLight& stray, const SphereLine& line,
                                      const std::vector<std::optional<Strength>>& lamp, const LitPlace& place,
                                      const Eigen::Vector3d& lamp_position) {
  const ShareModel model{stray, line, lamp, place, irradiance(place, lamp_position)};
  const double length_m = line.spacing_m * std::max(1, line.count - 1);
  const Eigen::Vector3d start = line.sphere(line.count / 2).centre;
  const Eigen::Vector3d position = stray.placed ? stray.position : start + kFarLines * length_m * stray.position;
  const auto ratio = stray_ratio(stray, position, line, lamp);
  if (!ratio) return std::nullopt;
  StrayShare share{model.at(position), {}};
  const Strength nearest = stray.placed ? share.value : model.at(start + kNearestLines * length_m * stray.position);
  if (stray.placed) share.sigma = model.by_position(stray.covariance);
  for (std::size_t c = 0; c < 3; ++c) {
    share.sigma[c] = std::hypot(share.sigma[c], nearest[c] - share.value[c], ratio->relative_sigma * share.value[c]);
  }
  return share;
}

}  // namespace lumitexel
