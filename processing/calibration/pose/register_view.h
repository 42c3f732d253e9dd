// The mesh registered to one view by its silhouette, after Lensch, Heidrich and Seidel, "Automated texture registration and
// stitching for real world models" (2000) and "A silhouette-based algorithm for texture registration" (2001); here by
// contour distances with analytic derivatives instead of the difference of two silhouettes' areas.
//
// Needs a start within the given range and no user. What the silhouette does not determine is reported, not solved:
// a motion under which the contour stays (a surface of revolution about its axis), and other poses that show the same contour
// (a cube's quarter turns).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "processing/calibration/pose/pose_search.h"

namespace lumitexel {

// A turn of the mesh about an axis through its box's middle that the silhouette hardly tells from none.
struct PoseAmbiguity {
  Eigen::Vector3d axis_in_mesh = Eigen::Vector3d::UnitZ();  // unit
  double angle_deg = 0;                                     // 0: any small angle; else just this one
};

struct ViewRegistrationOptions {
  SearchRange search;                // a shift_m and turn_deg of 0: the start is within some pixels
  bool other_rotations = true;       // whether to look for equally good poses among all rotations
  std::optional<RimModel> model;     // none: both are tried and the one that fits better is taken
  std::size_t rim_points = 2000;     // of the outline; more cost time and gain accuracy until there is one a pixel
  // A turn by an angle that moves points of the object by p pixels must move the contour by this share of p (rms).
  double least_turn_share = 0.012;
};

struct ViewRegistration {
  bool converged = false;
  std::string problem;  // why not, or why the pose is ambiguous; empty if all is well
  Eigen::Isometry3d camera_from_mesh = Eigen::Isometry3d::Identity();
  Eigen::Vector3d centre_in_mesh = Eigen::Vector3d::Zero();  // about which the covariance is stated
  PoseCovariance covariance = PoseCovariance::Zero();
  double sigma_m = 0, sigma_deg = 0;  // roots of the traces of the covariance's two halves: of |shift|, |turn|
  double silhouette_px = 0;           // median distance of outline and contour
  double explained = 0;               // share of the outline that lies on the contour
  double independent = 0;             // as many independent contour points say as much
  RimModel model = RimModel::Smooth;
  std::vector<PoseAmbiguity> ambiguities;
  bool ambiguous() const { return !ambiguities.empty(); }
};

// Throws BadInput for a start that is not a finite pose or whose object's centre is behind the camera.
ViewRegistration register_view(const MeshSilhouette& mesh, const ContourLookup& contour, const CameraModel& camera,
                               const Eigen::Isometry3d& camera_from_mesh_start,
                               const ViewRegistrationOptions& options = {});

// Directions of turning that the equations do not determine, shifts being free. information: of a PoseStep, in 1/px^2 of
// distance per unit of weight (mean over points); metres of radius_m and px_per_m make a turn a motion in pixels.
std::vector<PoseAmbiguity> undetermined_turns(const PoseCovariance& information, const Eigen::Matrix3d& camera_from_mesh,
                                              double radius_m, double px_per_m, double least_turn_share);

}  // namespace lumitexel
