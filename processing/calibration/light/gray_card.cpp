#include "processing/calibration/light/gray_card.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/error.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

constexpr double kInset = 0.15;      // of the edge, on every side
constexpr double kClipSigmas = 4.0;  // of the robust mean

struct CardPlane {
  Eigen::Vector3d centre, normal, right, up;  // rig frame
  double half_m;
};

CardPlane card_plane(const GrayCardDescription& card) {
  CardPlane plane;
  plane.centre = card.centre_in_rig;
  plane.normal = card.normal_in_rig.normalized();
  plane.up = (card.up_in_rig - card.up_in_rig.dot(plane.normal) * plane.normal).normalized();
  plane.right = plane.up.cross(plane.normal);
  plane.half_m = card.size_m * (0.5 - kInset);
  return plane;
}

struct PixelBox {
  int x0, y0, x1, y1;  // inclusive
};

PixelBox picture_of(const CardPlane& plane, const CameraModel& camera, const Eigen::Isometry3d& camera_from_rig) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const double u : {-1.0, 1.0}) {
    for (const double v : {-1.0, 1.0}) {
      const Eigen::Vector3d corner = plane.centre + plane.half_m * (u * plane.right + v * plane.up);
      const Eigen::Vector3d in_camera = camera_from_rig * corner;
      if (in_camera.z() <= 0.0 || !camera.contains(camera.project(in_camera))) {
        throw BadInput("rig.toml: gray_card", "a corner of its inner part is out of the picture",
                       "a card in the camera's sight");
      }
      low = low.min(camera.project(in_camera).array());
      high = high.max(camera.project(in_camera).array());
    }
  }
  return {static_cast<int>(low.x()), static_cast<int>(low.y()), static_cast<int>(high.x()), static_cast<int>(high.y())};
}

// Radiance of the card per intensity at the point that the pixel sees; 0 outside its inner part.
double radiance_per_intensity(const CardPlane& plane, const Eigen::Vector3d& eye, const Eigen::Vector3d& direction,
                              const Eigen::Vector3d& light, double albedo) {
  const double along = (plane.centre - eye).dot(plane.normal) / direction.dot(plane.normal);
  const Eigen::Vector3d x = eye + along * direction, offset = x - plane.centre;
  if (std::abs(offset.dot(plane.right)) > plane.half_m || std::abs(offset.dot(plane.up)) > plane.half_m) return 0.0;
  const Eigen::Vector3d to_light = light - x;
  const double distance2 = to_light.squaredNorm();
  return albedo / std::numbers::pi * std::max(0.0, to_light.dot(plane.normal)) / (distance2 * std::sqrt(distance2));
}

struct RobustMean {
  double mean = 0, deviation = 0;
  std::int64_t count = 0;
};

RobustMean robust_mean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double median = values[values.size() / 2];
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - median));
  std::nth_element(deviations.begin(), deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2),
                   deviations.end());
  const double bound = kClipSigmas * 1.4826 * deviations[deviations.size() / 2];
  RobustMean result;
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    if (std::abs(value - median) > bound) continue;
    sum += value;
    squares += (value - median) * (value - median);
    ++result.count;
  }
  const auto n = static_cast<double>(result.count);
  result.mean = sum / n;
  result.deviation = std::sqrt(std::max(0.0, squares / n - (result.mean - median) * (result.mean - median)));
  return result;
}

}  // namespace

GrayCardIntensity measure_gray_card(const MosaicRadiance& card, const CameraModel& camera,
                                    const Eigen::Isometry3d& camera_from_rig, const GrayCardDescription& description,
                                    const Eigen::Vector3d& light_in_rig) {
  const CardPlane plane = card_plane(description);
  const Eigen::Isometry3d rig_from_camera = camera_from_rig.inverse();
  const Eigen::Vector3d eye = rig_from_camera.translation();
  if ((eye - plane.centre).dot(plane.normal) <= 0.0 || (light_in_rig - plane.centre).dot(plane.normal) <= 0.0) {
    throw BadInput("rig.toml: gray_card.normal_in_rig", "the card faces away from the camera or the light",
                   "a visible, lit card");
  }
  const PixelBox box = picture_of(plane, camera, camera_from_rig);
  std::vector<std::vector<double>> values(static_cast<std::size_t>(mosaic_channels(card.mosaic)));
  for (int y = box.y0; y <= box.y1; ++y) {
    for (int x = box.x0; x <= box.x1; ++x) {
      if (card.flags[card.index(x, y)] != 0) continue;
      const Eigen::Vector3d direction = rig_from_camera.linear() * camera.unproject({x + 0.5, y + 0.5});
      const double expected = radiance_per_intensity(plane, eye, direction, light_in_rig, description.albedo);
      if (expected <= 0.0) continue;
      values[static_cast<std::size_t>(mosaic_channel(card.mosaic, x, y))].push_back(card.value[card.index(x, y)] /
                                                                                    expected);
    }
  }
  GrayCardIntensity result;
  for (std::vector<double>& channel : values) {
    if (channel.empty()) {
      throw BadInput("gray-card bracket", "no usable pixel on the card in some channel",
                     "exposures in which the card is neither dark nor saturated");
    }
    const RobustMean mean = robust_mean(std::move(channel));
    result.intensity.push_back(mean.mean);
    result.pixel_scatter.push_back(mean.deviation / mean.mean);
    result.relative_sigma.push_back(mean.deviation / mean.mean / std::sqrt(static_cast<double>(mean.count)));
    result.pixels.push_back(mean.count);
  }
  return result;
}

}  // namespace lumitexel
