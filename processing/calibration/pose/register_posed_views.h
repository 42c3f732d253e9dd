// Views whose poses somebody gave (another program's, say), held against the silhouettes of a mesh, all views at once.
//
// Each view's pose is an unknown of its own. What all views share is one too: by how much their contours lie outside of the
// mesh's (a mask whose rim belongs to the object or not, a mesh that is too thin), which one view takes for distance; and, if
// asked for, focal length and principal point. The given poses take part as evidence: they are right up to errors that are
// normally distributed about zero, of a spread that the views themselves tell (turn, across the view and along it apart; by
// expectation and maximisation of the marginal likelihood, Dempster, Laird and Rubin 1977). So directions in which the outline says
// little keep what was given, and exact poses are not traded for the contours' noise.
//
// Whether a given pose is contradicted is asked of the contour alone: its score at the given pose against the score's covariance,
// with neighbouring contour errors correlated (residual_correlation.h), six degrees of freedom, at a level for the session as a whole
// (Holm 1979). Starts are the given poses: they must be right within some ten pixels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "processing/calibration/pose/posed_view_equations.h"
#include "processing/calibration/pose/register_view.h"

namespace lumitexel {

struct PosedViewsOptions {
  double level = 0.05;              // chance that correct poses, or a correct lens, are contradicted
  bool refine_lens = true;          // only done if all views have one camera
  double rim_offset_sigma_px = 1.0; // how far contours may lie off the mesh's outline all around
  std::optional<RimModel> model;    // none: the one that fits better
  std::size_t rim_points = 10000;   // over all views
  double least_turn_share = 0.012;  // see ViewRegistrationOptions
};

struct RegisteredPosedView {
  bool measured = false;     // false: no contour, or most of the outline lies on none; nothing below is known then
  bool contradicted = false; // the silhouettes say that the given pose is wrong; never so where they do not determine it
  std::string problem;       // why it was not measured, or why the silhouettes do not determine the pose
  Eigen::Isometry3d camera_from_mesh = Eigen::Isometry3d::Identity();  // by contour and given poses
  PoseCovariance covariance = PoseCovariance::Zero();                  // of a PoseStep about the mesh's middle
  double sigma_m = 0, sigma_deg = 0;                                   // as in ViewRegistration
  double chi_square = 0;                                               // of the given pose, six degrees of freedom
  double given_px = 0, silhouette_px = 0;  // median distance of outline and contour, at the given pose and at the registered one
  double explained = 0;                    // share of the outline that lies on the contour
  double contour_share = 0, given_share = 0, rim_share = 0;  // of the shift's variance; they sum to 1
};

struct PosedViewsRegistration {
  bool converged = false;
  std::string problem;  // why not
  std::vector<RegisteredPosedView> views;
  PoseSpread spread;    // upper end: estimate and its sigma
  double rim_offset_px = 0, rim_offset_sigma_px = 0;  // positive: contours lie outside of the mesh's outline
  // Focal length as a factor, principal point in pixels: found, and their covariance. Both empty if not asked for.
  std::optional<Eigen::Vector3d> lens_step;
  Eigen::Matrix3d lens_covariance = Eigen::Matrix3d::Zero();
  double lens_chi_square = 0;      // of the given lens, three degrees of freedom
  bool lens_contradicted = false;  // if not, lens_step was not taken and the poses are those under the given lens
  RimModel rim = RimModel::Smooth;
  double independent = 0;          // contour points that say as much as all correlated ones
};

// Throws BadInput for no views, or a given pose that is not finite or has the object behind the camera.
PosedViewsRegistration register_posed_views(const MeshSilhouette& mesh, const std::vector<PosedView>& views,
                                            const PosedViewsOptions& options = {});

}  // namespace lumitexel
