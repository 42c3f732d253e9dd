#include "processing/calibration/light/sphere_reflection.h"

#include <Eigen/Geometry>
#include <cmath>

namespace lumitexel {
namespace {

// Angle at the sphere's surface point between the normal and the direction to a point at distance d from the centre,
// `turned` away from the normal as seen from the centre; and its derivative by `turned`.
struct SurfaceAngle {
  double value, slope;
};

SurfaceAngle surface_angle(double distance, double radius, double turned) {
  const double across = distance * std::sin(turned), along = distance * std::cos(turned) - radius;
  return {std::atan2(across, along),
          (distance * distance - distance * radius * std::cos(turned)) / (across * across + along * along)};
}

}  // namespace

Eigen::Vector3d mirror_point(const MirrorSphere& sphere, const Eigen::Vector3d& eye, const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_eye = eye - sphere.centre, to_light = light - sphere.centre;
  const double eye_distance = to_eye.norm(), light_distance = to_light.norm();
  const Eigen::Vector3d e = to_eye / eye_distance;
  const Eigen::Vector3d across = to_light - to_light.dot(e) * e;
  const double across_norm = across.norm();
  if (across_norm == 0.0) return sphere.centre + sphere.radius_m * e;
  // In the plane of eye, centre and light: the normal is turned by phi from the eye's side, between 0 and opening. The
  // difference of the two angles at the surface grows with phi, so Newton kept inside a shrinking bracket must arrive.
  const double opening = std::atan2(across_norm, to_light.dot(e));
  double low = 0.0, high = opening, phi = 0.5 * opening;
  constexpr int kMaxIterations = 60;
  for (int i = 0; i < kMaxIterations; ++i) {
    const SurfaceAngle at_eye = surface_angle(eye_distance, sphere.radius_m, phi);
    const SurfaceAngle at_light = surface_angle(light_distance, sphere.radius_m, opening - phi);
    const double difference = at_eye.value - at_light.value;
    (difference > 0.0 ? high : low) = phi;
    double next = phi - difference / (at_eye.slope + at_light.slope);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - phi);
    phi = next;
    if (step < 1e-16) break;
  }
  return sphere.centre + sphere.radius_m * (std::cos(phi) * e + std::sin(phi) * across / across_norm);
}

std::optional<Ray> mirrored_ray(const MirrorSphere& sphere, const Ray& from_eye) {
  const Eigen::Vector3d to_origin = from_eye.origin - sphere.centre;
  const double half_b = to_origin.dot(from_eye.direction);
  const double discriminant = half_b * half_b - to_origin.squaredNorm() + sphere.radius_m * sphere.radius_m;
  if (discriminant <= 0.0) return std::nullopt;
  const double distance = -half_b - std::sqrt(discriminant);
  if (distance <= 0.0) return std::nullopt;
  const Eigen::Vector3d point = from_eye.origin + distance * from_eye.direction;
  const Eigen::Vector3d normal = (point - sphere.centre) / sphere.radius_m;
  return Ray{point, from_eye.direction - 2.0 * from_eye.direction.dot(normal) * normal};
}

}  // namespace lumitexel
