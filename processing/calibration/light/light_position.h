// Where the point light was in every view, from its highlights on the spheres (the paper's section on the light
// source's position, then refined on the true geometry).
//
// Every highlight gives a mirrored ray that leads to the light; the point nearest to all of them starts a non-linear
// least squares fit of all highlight pixels, over the sphere line (5 parameters: it stands still, so all views share
// it) and every view's light (3 each): ring highlights to the centroid of the ring's reflection, point highlights to
// the exact mirror point. Heavy-tailed (Cauchy) loss: a highlight of something else cannot drag the result.
//
// Everything here is in the camera's frame, in metres; pixels are distorted pixels of the camera.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/sphere_line.h"

namespace lumitexel {

struct HighlightPixel {
  int sphere = 0;  // index along the line
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 0.05;  // per axis
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
// Pixels at which it sees emitters that stand evenly around the lens in the camera's xy plane.
std::vector<Eigen::Vector2d> ring_highlight_pixels(const CameraModel& camera, const MirrorSphere& sphere,
                                                   double ring_radius_m);
// Their centroid: that of the reflection of a ring of the given radius.
Eigen::Vector2d ring_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere, double ring_radius_m);

// A light of some extent: an evenly bright disc about its position, facing a point (the arm's pivot). Its highlight is the
// centroid of the disc's reflection, which to second order is that of a ring of radius / sqrt(2).
struct EmitterDisc {
  double radius_m = 0;  // 0: a point
  Eigen::Vector3d faces = Eigen::Vector3d::UnitZ();  // camera's frame, m
};
Eigen::Vector2d disc_highlight_pixel(const CameraModel& camera, const MirrorSphere& sphere,
                                     const Eigen::Vector3d& light, const EmitterDisc& emitter);

struct MeasuredLight {
  // False, and position and covariance mean nothing: fewer than three highlights; a distance uncertain by half of itself or
  // more; a light farther away than 200 lengths of the line of spheres.
  bool measured = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
  Eigen::Matrix3d own_covariance =
      Eigen::Matrix3d::Zero();  // the part that other views do not share: the line held fixed
  int highlights = 0;
  int outliers = 0;        // highlights farther than 5 sigma from the fit
  double residual_px = 0;  // rms of a coordinate over this view's highlights, outliers left out
};

struct LightSolution {
  SphereLine line;
  std::vector<MeasuredLight> lights;  // as the views given
  double residual_px = 0;             // rms over everything, outliers left out
  double sigma_scale = 1;  // residuals over the highlights' stated sigmas; covariances are scaled by its square
  // What the lights' errors have in common through the sphere line (the mean covariance between two views' lights): no
  // number of views and no arm averages it away. Zero with fewer than two lights.
  Eigen::Matrix3d shared_covariance = Eigen::Matrix3d::Zero();
  bool converged = false;
};

// rings: highlights of the ring flash, any number per sphere. points: one list a view, possibly empty.
// Throws BadInput if rings do not cover three spheres or more.
LightSolution solve_lights(const CameraModel& camera, const SphereLine& start, double ring_radius_m,
                           const std::vector<HighlightPixel>& rings,
                           const std::vector<std::vector<HighlightPixel>>& points, const EmitterDisc& emitter = {});

}  // namespace lumitexel
