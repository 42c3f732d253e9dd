#include "processing/calibration/light/stray_lights.h"

#include <Eigen/LU>
#include <algorithm>

namespace lumitexel {
namespace {

// All views share the sphere line's error, and so lie nearer to one another than these covariances say: a light that moved by
// less than a few centimetres at a metre may pass for one that stood.
bool stands_there(const StrayLight& light, const MeasuredLight& seen) {
  constexpr double kChiSquare3At999 = 16.27;
  const Eigen::Vector3d between = seen.position - light.position;
  return between.dot((light.covariance + seen.covariance).inverse() * between) < kChiSquare3At999;
}

void merge(StrayLight& light, const MeasuredLight& seen, std::size_t view) {
  const Eigen::Matrix3d had = light.covariance.inverse(), more = seen.covariance.inverse();
  light.covariance = (had + more).inverse();
  light.position = light.covariance * (had * light.position + more * seen.position);
  light.views.push_back(view);
}

}  // namespace

std::vector<StrayLight> locate_stray_lights(const SphereHighlights& seen, const CameraModel& camera,
                                            const RigDescription& rig) {
  std::vector<std::vector<HighlightPixel>> all;
  std::vector<std::size_t> view_of;
  for (std::size_t v = 0; v < seen.strays.size(); ++v) {
    for (const std::vector<HighlightPixel>& stray : seen.strays[v]) {
      all.push_back(stray);
      view_of.push_back(v);
    }
  }
  std::vector<StrayLight> lights;
  if (all.empty()) return lights;
  const LightSolution solution = solve_lights(camera, seen.line, rig.ring_flash.radius_m, seen.rings, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const MeasuredLight& light = solution.lights[i];
    if (!light.measured) continue;
    const auto known = std::find_if(lights.begin(), lights.end(), [&](const StrayLight& other) {
      return other.views.back() != view_of[i] && stands_there(other, light);
    });
    if (known == lights.end()) {
      lights.push_back({{view_of[i]}, light.position, light.covariance});
    } else {
      merge(*known, light, view_of[i]);
    }
  }
  return lights;
}

}  // namespace lumitexel
