// Where a light's highlights are on a line of spheres, and back: a first estimate of the light from its highlights.
//
// Everything here is in the camera's frame, in metres; pixels are distorted pixels of the camera.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/sphere_line.h"

namespace lumitexel {

struct HighlightPixel {
  int sphere = 0;  // index along the line
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 0.05;  // per axis
  // Light in it, per colour of the mosaic (mono: three times the same): flux_of(fit) by the fit's balance. 0: not known, as red
  // and blue of a mosaic that was binned (read_sphere_highlights: spheres of 80 px radius and more), which is its green alone.
  std::array<double, 3> flux{};
};

// The point nearest to all rays in the least squares sense. None if the rays are fewer than two or parallel.
std::optional<Eigen::Vector3d> nearest_point(const std::vector<Ray>& rays);

// First estimate of one light from its highlights: the nearest point of all mirrored rays, or of a pair of them if that
// agrees better with the median highlight (so a minority of false ones does no harm). None if fewer than two of them
// lie on their spheres.
std::optional<Eigen::Vector3d> light_from_highlights(const CameraModel& camera, const SphereLine& line,
                                                     const std::vector<HighlightPixel>& highlights);

// Pixel at which the camera sees `light` mirrored in the sphere.
Eigen::Vector2d highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, const Eigen::Vector3d& light);
// One of several emitters alike: where it is seen mirrored, and its share of their light, which falls with its distance from there
// squared. They are taken to shine evenly to all sides: what a lamp's own pattern adds nobody has told yet when this is asked. Shares sum to 1.
struct EmitterImage {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // on the sphere
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double share = 0;
};
std::vector<EmitterImage> emitter_images(const CameraModel& camera, const MirrorSphere& sphere, const std::vector<Eigen::Vector3d>& emitters);
Eigen::Vector2d centroid(const std::vector<EmitterImage>& images);

// Of emitters that stand evenly around the lens in the camera's xy plane.
std::vector<EmitterImage> ring_images(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m);
// Their centroid: that of the reflection of a ring of the given radius.
Eigen::Vector2d ring_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m);

// A light of some extent: an evenly bright disc about its position, facing a point (the arm's pivot). Its highlight is the
// centroid of the disc's reflection, which to second order is that of a ring of radius / sqrt(2).
struct EmitterDisc {
  double radius_m = 0;  // 0: a point
  Eigen::Vector3d faces = Eigen::Vector3d::UnitZ();  // camera's frame, m
};
// Twelve places on it that stand for equal areas.
std::vector<Eigen::Vector3d> places_on_disc(const Eigen::Vector3d& light, const EmitterDisc& emitter);
Eigen::Vector2d disc_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere,
                                     const Eigen::Vector3d& light, const EmitterDisc& emitter);

}  // namespace lumitexel
