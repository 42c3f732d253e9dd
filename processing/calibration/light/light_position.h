// Where the point light was in every view, from its highlights on the spheres (the paper's section on the light
// source's position, then refined on the true geometry).
//
// Every highlight gives a mirrored ray that leads to the light; the point nearest to all of them starts a non-linear
// least squares fit of all highlight pixels, over the sphere line (5 parameters: it stands still, so all views share
// it), every view's light (3 each) and, if it is given a covariance, the lens: ring highlights to the centroid of the ring's reflection, point highlights to
// the exact mirror point. Heavy-tailed (Cauchy) loss: a highlight of something else cannot drag the result.
//
// Everything here is in the camera's frame, in metres; pixels are distorted pixels of the camera.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "processing/calibration/lens/lens_vector.h"
#include "processing/calibration/light/highlight_geometry.h"

namespace lumitexel {

struct MeasuredLight {
  // False, and position and covariance mean nothing: fewer than three highlights; a distance uncertain by half of itself or
  // more; a light farther away than 200 lengths of the line of spheres.
  bool measured = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
  Eigen::Matrix3d own_covariance =
      Eigen::Matrix3d::Zero();  // the part that other views do not share: the line (and a free lens) held fixed
  // With a free lens: covariance of the lens's parameters and the position.
  Eigen::Matrix<double, kLensParameters, 3> with_lens = Eigen::Matrix<double, kLensParameters, 3>::Zero();
  int highlights = 0;
  int outliers = 0;        // highlights farther than 5 sigma from the fit
  double residual_px = 0;  // rms of a coordinate over this view's highlights, outliers left out
};

// What the highlights make of a lens that is known with some uncertainty only.
struct RefinedLens {
  CameraModel camera;
  LensMatrix covariance = LensMatrix::Zero();
  double chi2_gain = 0;  // by how much chi square, the prior's included, is lower than with the lens held
};

struct LightSolution {
  SphereLine line;
  std::vector<MeasuredLight> lights;  // as the views given
  double residual_px = 0;             // rms over everything, outliers left out
  double sigma_scale = 1;  // residuals over the highlights' stated sigmas; covariances are scaled by its square, but with a free lens
  // What the lights' errors have in common through the sphere line (the mean covariance between two views' lights): no
  // number of views and no arm averages it away. Zero with fewer than two lights.
  Eigen::Matrix3d shared_covariance = Eigen::Matrix3d::Zero();
  bool converged = false;
  std::optional<RefinedLens> lens;  // if it was free
};

// rings: highlights of the ring flash, any number per sphere. points: one list a view, possibly empty.
// lens_covariance: highlights' sigmas are taken at their word, and the lens is one more unknown, known beforehand to be `camera` with this covariance (a parameter without
// variance stays); none: it is exact. Throws BadInput if rings do not cover three spheres or more.
LightSolution solve_lights(const CameraModel& camera, const SphereLine& start, double ring_radius_m,
                           const std::vector<HighlightPixel>& rings,
                           const std::vector<std::vector<HighlightPixel>>& points, const EmitterDisc& emitter = {},
                           const std::optional<LensMatrix>& lens_covariance = {});

}  // namespace lumitexel
