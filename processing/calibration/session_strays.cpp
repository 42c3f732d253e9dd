#include "processing/calibration/session_strays.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kUnknownShare = 1.0;

bool is_there(const StrayLight& stray, std::size_t view) {
  return stray.views.size() > 1 || stray.views.front() == view;
}

}  // namespace

SessionStrays::SessionStrays(const SphereHighlights& seen, const SessionLights& lights, const CameraModel& camera,
                             const RigDescription& rig)
    : camera_from_rig_(rig.camera.camera_from_rig), line_(lights.spheres.line), strays_(locate_stray_lights(seen, camera, rig)),
      lamp_(lamp_strengths(seen, lights.spheres)), channels_(static_cast<std::size_t>(mosaic_channels(rig.camera.limits.mosaic))) {
  for (const ArmPrediction& light : lights.in_rig) lamps_in_rig_.push_back(light.position_in_rig);
}

LitPlace SessionStrays::in_camera(const LitPlace& place) const {
  return {camera_from_rig_ * place.position, camera_from_rig_.linear() * place.normal.normalized()};
}

std::vector<double> SessionStrays::shares(const LitPlace& place, const Eigen::Vector3d& lamp_in_rig, std::size_t view) const {
  if (strays_.empty()) return {};
  std::vector<double> sums(channels_, 0.0), squares(channels_, 0.0);
  for (const StrayLight& stray : strays_) {
    if (!is_there(stray, view)) continue;
    const auto share = stray_share(stray, line_, lamp_, in_camera(place), camera_from_rig_ * lamp_in_rig);
    for (std::size_t c = 0; c < channels_; ++c) {
      sums[c] += share[c] ? share[c]->value : kUnknownShare;
      squares[c] += share[c] ? share[c]->sigma * share[c]->sigma : 0.0;
    }
  }
  for (std::size_t c = 0; c < channels_; ++c) sums[c] = std::sqrt(sums[c] * sums[c] + squares[c]);
  return sums;
}

std::size_t SessionStrays::nearest_view(const Eigen::Vector3d& lamp_in_rig) const {
  const auto nearest = std::min_element(lamps_in_rig_.begin(), lamps_in_rig_.end(), [&](const auto& a, const auto& b) {
    return (a - lamp_in_rig).squaredNorm() < (b - lamp_in_rig).squaredNorm();
  });
  return static_cast<std::size_t>(nearest - lamps_in_rig_.begin());
}

std::vector<double> SessionStrays::shares(const LitPlace& place, const Eigen::Vector3d& lamp_in_rig) const {
  return shares(place, lamp_in_rig, nearest_view(lamp_in_rig));
}

std::vector<StrayLightSummary> SessionStrays::summarise(const std::vector<std::string>& view_names, const LitPlace& card,
                                                        const Eigen::Vector3d& lamp_in_rig) const {
  std::vector<StrayLightSummary> summaries;
  const Eigen::Isometry3d rig_from_camera = camera_from_rig_.inverse();
  for (const StrayLight& stray : strays_) {
    StrayLightSummary& light = summaries.emplace_back();
    for (const std::size_t v : stray.views) light.views.push_back(view_names[v]);
    light.placed = stray.placed;
    light.counted_in_scale = is_there(stray, nearest_view(lamp_in_rig));
    light.position_in_rig = stray.placed ? rig_from_camera * stray.position : rig_from_camera.linear() * stray.position;
    light.sigma_m = per_axis_sigma(stray.covariance);
    const auto share = stray_share(stray, line_, lamp_, in_camera(card), camera_from_rig_ * lamp_in_rig);
    for (std::size_t c = 0; c < channels_; ++c) {
      if (!share[c] || (light.card_share && share[c]->value <= *light.card_share)) continue;
      light.card_share = share[c]->value;
      light.card_share_sigma = share[c]->sigma;
    }
  }
  return summaries;
}

}  // namespace lumitexel
