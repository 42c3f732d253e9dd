#include "processing/calibration/light/highlight_geometry.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumitexel {
namespace {

double median_error_px(const CameraModel& camera, const SphereLine& line, const std::vector<HighlightPixel>& highlights,
                       const Eigen::Vector3d& light) {
  std::vector<double> errors;
  for (const HighlightPixel& seen : highlights) {
    const double error = (highlight_pixel(camera, line.sphere(seen.sphere), light) - seen.pixel).norm();
    errors.push_back(std::isfinite(error) ? error : std::numeric_limits<double>::infinity());
  }
  // The upper median: at least half of the highlights agree with the light this well.
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

}  // namespace

std::optional<Eigen::Vector3d> nearest_point(const std::vector<Ray>& rays) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
    normal += across;
    right += across * ray.origin;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(normal);
  if (rays.size() < 2 || lu.rcond() < 1e-9) return std::nullopt;  // parallel within some 1e-5 rad
  return lu.solve(right);
}

std::optional<Eigen::Vector3d> light_from_highlights(const CameraModel& camera, const SphereLine& line,
                                                     const std::vector<HighlightPixel>& highlights) {
  std::vector<Ray> rays;
  for (const HighlightPixel& seen : highlights) {
    const auto ray = mirrored_ray(line.sphere(seen.sphere), {Eigen::Vector3d::Zero(), camera.unproject(seen.pixel)});
    if (ray) rays.push_back(*ray);
  }
  // All rays together are the most precise, but one highlight of something else would spoil them; then some pair wins.
  std::optional<Eigen::Vector3d> best;
  double best_error = std::numeric_limits<double>::infinity();
  const auto consider = [&](const std::vector<Ray>& chosen) {
    const auto candidate = nearest_point(chosen);
    if (!candidate) return;
    const double error = median_error_px(camera, line, highlights, *candidate);
    if (error < best_error) {
      best_error = error;
      best = candidate;
    }
  };
  consider(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = i + 1; j < rays.size(); ++j) consider({rays[i], rays[j]});
  }
  return best;
}

Eigen::Vector2d highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, const Eigen::Vector3d& light) {
  return camera.project(mirror_point(sphere, Eigen::Vector3d::Zero(), light));
}

std::vector<EmitterImage> emitter_images(const CameraModel& camera, const MirrorSphere& sphere, const std::vector<Eigen::Vector3d>& emitters) {
  std::vector<EmitterImage> images;
  double sum = 0.0;
  for (const Eigen::Vector3d& emitter : emitters) {
    const Eigen::Vector3d point = mirror_point(sphere, Eigen::Vector3d::Zero(), emitter);
    images.push_back({point, camera.project(point), 1.0 / (emitter - point).squaredNorm()});
    sum += images.back().share;
  }
  for (EmitterImage& image : images) image.share /= sum;
  return images;
}

Eigen::Vector2d centroid(const std::vector<EmitterImage>& images) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const EmitterImage& image : images) sum += image.share * image.pixel;
  return sum;
}

std::vector<EmitterImage> ring_images(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m) {
  // Opposite emitters cancel to first order, but for their distances; eight catch what is left, since the next terms are of fourth order.
  constexpr int kEmitters = 8;
  std::vector<Eigen::Vector3d> emitters;
  for (int i = 0; i < kEmitters; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kEmitters;
    emitters.emplace_back(ring_radius_m * std::cos(angle), ring_radius_m * std::sin(angle), 0.0);
  }
  return emitter_images(camera, sphere, emitters);
}

Eigen::Vector2d ring_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m) {
  return centroid(ring_images(camera, sphere, ring_radius_m));
}

std::vector<Eigen::Vector3d> places_on_disc(const Eigen::Vector3d& light, const EmitterDisc& emitter) {
  const Eigen::Vector3d normal = (emitter.faces - light).normalized();
  const Eigen::Vector3d across = normal.unitOrthogonal(), other = normal.cross(across);
  std::vector<Eigen::Vector3d> places;
  // A third of the disc within 0.577 of its radius, the rest outside; mean squared radii 1/6 and 2/3.
  for (const auto& [count, square] : {std::pair{4, 1.0 / 6.0}, std::pair{8, 2.0 / 3.0}}) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.5) / count;
      places.push_back(light + emitter.radius_m * std::sqrt(square) * (std::cos(angle) * across + std::sin(angle) * other));
    }
  }
  return places;
}

Eigen::Vector2d disc_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere,
                                     const Eigen::Vector3d& light, const EmitterDisc& emitter) {
  if (!(emitter.radius_m > 0.0)) return highlight_pixel(camera, sphere, light);
  const Eigen::Vector3d normal = (emitter.faces - light).normalized();
  const Eigen::Vector3d across = normal.unitOrthogonal(), other = normal.cross(across);
  constexpr int kPlaces = 8;  // as for the ring flash
  const double radius = emitter.radius_m / std::numbers::sqrt2;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPlaces;
    places.push_back(light + radius * (std::cos(angle) * across + std::sin(angle) * other));
  }
  return centroid(emitter_images(camera, sphere, places));
}

}  // namespace lumitexel
