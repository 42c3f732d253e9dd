#include "processing/calibration/light/stray_share.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "processing/calibration/light/median.h"
#include "processing/calibration/light/student_bound.h"

namespace lumitexel {
namespace {

// What every highlight's flux has in common: the profile's tails beyond the fitted window, the mirror's reflectance growing
// towards the rim. Rendered spheres of rough metal scatter by less.
constexpr double kCommonError = 0.02;
constexpr double kLeastOfBrightest = 0.02;  // a colour with less is the profile's error, not a light's
constexpr double kClearSigmas = 3.0;
constexpr std::size_t kLeastSpheres = 2;
constexpr double kMedianOverMean = 1.25;  // standard deviation of a median over that of a mean
// A light that is not placed stands at least this many lengths of the line of spheres away; beyond the second nothing changes.
constexpr double kNearestLines = 10.0, kFarLines = 1000.0;

double squared_distance(const SphereLine& line, int sphere, const Eigen::Vector3d& light) {
  return (light - mirror_point(line.sphere(sphere), Eigen::Vector3d::Zero(), light)).squaredNorm();
}

double irradiance(const LitPlace& place, const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_light = light - place.position;
  const double square = to_light.squaredNorm();
  return std::max(0.0, to_light.dot(place.normal)) / (square * std::sqrt(square));
}

// Of one light on one sphere: F d^2 by highlight, per colour; a flux of 0 is not known.
using Fluxes = std::array<std::vector<double>, 3>;

void add(Fluxes& fluxes, const HighlightPixel& seen, double squared_distance_m2) {
  if (!(seen.flux[1] > 0.0)) return;
  for (std::size_t c = 0; c < 3; ++c) {
    if (seen.flux[c] != 0.0) fluxes[c].push_back(seen.flux[c] * squared_distance_m2);
  }
}

Strength strength_of(const Fluxes& fluxes) {
  std::array<double, 3> middle{};
  for (std::size_t c = 0; c < 3; ++c) middle[c] = fluxes[c].empty() ? 0.0 : median(fluxes[c]);
  const double least = kLeastOfBrightest * *std::max_element(middle.begin(), middle.end());
  Strength strength;
  for (std::size_t c = 0; c < 3; ++c) {
    if (middle[c] > least) strength[c] = middle[c];
  }
  return strength;
}

// Standard deviation over the median absolute deviation about a sample's own median (Croux, Rousseeuw 1992: small samples'
// deviations are too small by more than the Gaussian's 1.4826).
double sigma_per_deviation(std::size_t count) {
  constexpr double kSmall[] = {1.196, 1.495, 1.363, 1.206, 1.200, 1.140, 1.129, 1.107};  // of two to nine
  const auto n = static_cast<double>(count);
  return 1.4826 * (count < 10 ? kSmall[count - 2] : n / (n - 0.8));
}

std::optional<MeasuredShare> ratio_of(const std::vector<double>& spheres) {
  if (spheres.size() < kLeastSpheres) return std::nullopt;
  const double value = median(spheres);
  std::vector<double> off;
  for (const double ratio : spheres) off.push_back(std::abs(ratio - value));
  const auto count = static_cast<double>(spheres.size());
  const double scatter = kMedianOverMean * sigma_per_deviation(spheres.size()) * median(off) / std::sqrt(count);
  if (!(value > student_bound(count - 1.0, kClearSigmas) * scatter)) return std::nullopt;
  return MeasuredShare{value, std::hypot(kCommonError * value, student_bound(count - 1.0, 1.0) * scatter)};
}

struct ShareModel {
  const StrayLight& stray;
  const SphereLine& line;
  const std::vector<Strength>& lamp;
  const LitPlace& place;
  double lamp_irradiance;

  ShareOfChannels at(const Eigen::Vector3d& position) const {
    ShareOfChannels share = stray_ratio(stray, position, line, lamp);
    const double factor = irradiance(place, position) / lamp_irradiance;
    for (auto& channel : share) {
      if (channel) *channel = {factor * channel->value, factor * channel->sigma};
    }
    return share;
  }

  // Adds the variance by the position's covariance: half the difference over both ends of each column of its Cholesky root (to first
  // order any root does).
  void add_position(const Eigen::Matrix3d& covariance, ShareOfChannels& share) const {
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    for (int column = 0; column < 3; ++column) {
      add_difference(at(stray.position + root.col(column)), at(stray.position - root.col(column)), 0.5, share);
    }
  }

  // A channel that is known at one end only is not known well enough.
  static void add_difference(const ShareOfChannels& up, const ShareOfChannels& down, double times, ShareOfChannels& share) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!share[c]) continue;
      if (!up[c] || !down[c]) {
        share[c].reset();
        continue;
      }
      share[c]->sigma = std::hypot(share[c]->sigma, times * (up[c]->value - down[c]->value));
    }
  }
};

}  // namespace

std::vector<Strength> lamp_strengths(const SphereHighlights& seen, const LightSolution& lights) {
  std::vector<Fluxes> fluxes(static_cast<std::size_t>(lights.line.count));
  for (std::size_t v = 0; v < seen.points.size(); ++v) {
    if (!lights.lights[v].measured) continue;
    for (const HighlightPixel& point : seen.points[v]) {
      if (point.sphere >= lights.line.count) continue;
      add(fluxes[static_cast<std::size_t>(point.sphere)], point, squared_distance(lights.line, point.sphere, lights.lights[v].position));
    }
  }
  std::vector<Strength> strengths;
  for (const Fluxes& sphere : fluxes) strengths.push_back(strength_of(sphere));
  return strengths;
}

ShareOfChannels stray_ratio(const StrayLight& stray, const Eigen::Vector3d& position, const SphereLine& line,
                            const std::vector<Strength>& lamp) {
  std::vector<Fluxes> fluxes(lamp.size());
  for (const HighlightPixel& seen : stray.highlights) {
    add(fluxes[static_cast<std::size_t>(seen.sphere)], seen, squared_distance(line, seen.sphere, position));
  }
  std::array<std::vector<double>, 3> ratios;
  for (std::size_t k = 0; k < lamp.size(); ++k) {
    const Strength strength = strength_of(fluxes[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      if (strength[c] && lamp[k][c]) ratios[c].push_back(*strength[c] / *lamp[k][c]);
    }
  }
  return {ratio_of(ratios[0]), ratio_of(ratios[1]), ratio_of(ratios[2])};
}

ShareOfChannels stray_share(const StrayLight& stray, const SphereLine& line, const std::vector<Strength>& lamp,
                            const LitPlace& place, const Eigen::Vector3d& lamp_position) {
  const ShareModel model{stray, line, lamp, place, irradiance(place, lamp_position)};
  if (!(model.lamp_irradiance > 0.0)) return {};
  if (stray.placed) {
    ShareOfChannels share = model.at(stray.position);
    model.add_position(stray.covariance, share);
    return share;
  }
  const double length_m = line.spacing_m * std::max(1, line.count - 1);
  const Eigen::Vector3d start = line.sphere(line.count / 2).centre;
  ShareOfChannels share = model.at(start + kFarLines * length_m * stray.position);
  const ShareOfChannels far = share;
  ShareModel::add_difference(model.at(start + kNearestLines * length_m * stray.position), far, 1.0, share);
  return share;
}

}  // namespace lumitexel
