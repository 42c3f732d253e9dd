#include "processing/calibration/light/stray_lights.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

namespace lumitexel {
namespace {

Eigen::Vector3d direction_of(const StrayLight& light, const Eigen::Vector3d& spheres) {
  return light.placed ? (light.position - spheres).normalized() : light.position;
}

// All views share the sphere line's error, and so lie nearer to one another than these covariances say: a light that moved by
// less than a few centimetres at a metre may pass for one that stood.
bool stands_there(const StrayLight& light, const StrayLight& seen, const Eigen::Vector3d& spheres) {
  constexpr double kChiSquare3At999 = 16.27;
  constexpr double kSameDirection = 0.03;  // rad; directions of far lights are good to a tenth of that
  if (!light.placed || !seen.placed) return (direction_of(seen, spheres) - direction_of(light, spheres)).norm() < kSameDirection;
  const Eigen::Vector3d between = seen.position - light.position;
  return between.dot((light.covariance + seen.covariance).inverse() * between) < kChiSquare3At999;
}

// A place is kept: a view that tells the direction alone adds nothing to it.
void merge(StrayLight& light, const StrayLight& seen) {
  if (light.placed && seen.placed) {
    const Eigen::Matrix3d had = light.covariance.inverse(), more = seen.covariance.inverse();
    light.covariance = (had + more).inverse();
    light.position = light.covariance * (had * light.position + more * seen.position);
  } else if (seen.placed) {
    light.position = seen.position;
    light.covariance = seen.covariance;
    light.placed = true;
  } else if (!light.placed) {
    light.position = (static_cast<double>(light.views.size()) * light.position + seen.position).normalized();
  }
  light.views.insert(light.views.end(), seen.views.begin(), seen.views.end());
  light.highlights.insert(light.highlights.end(), seen.highlights.begin(), seen.highlights.end());
}

std::optional<Eigen::Vector3d> mean_direction(const std::vector<HighlightPixel>& highlights, const CameraModel& camera,
                                              const SphereLine& line) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const HighlightPixel& seen : highlights) {
    const auto ray = mirrored_ray(line.sphere(seen.sphere), {Eigen::Vector3d::Zero(), camera.unproject(seen.pixel)});
    if (ray) sum += ray->direction;
  }
  return sum.norm() > 0.0 ? std::optional<Eigen::Vector3d>(sum.normalized()) : std::nullopt;
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
  const SphereLine& line = solution.line;
  const Eigen::Vector3d spheres = 0.5 * (line.sphere(0).centre + line.sphere(line.count - 1).centre);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const MeasuredLight& measured = solution.lights[i];
    StrayLight light{{view_of[i]}, measured.position, measured.covariance, measured.measured, all[i]};
    if (!light.placed) {
      const auto direction = mean_direction(all[i], camera, solution.line);
      if (!direction) continue;
      light.position = *direction;
      light.covariance.setZero();
    }
    const auto known = std::find_if(lights.begin(), lights.end(), [&](const StrayLight& other) {
      return other.views.back() != view_of[i] && stands_there(other, light, spheres);
    });
    if (known == lights.end()) {
      lights.push_back(std::move(light));
    } else {
      merge(*known, light);
    }
  }
  return lights;
}

}  // namespace lumitexel
