// All views of one turntable registered together: the mesh's silhouettes, tags on the table if there are any, the table's
// angles as read back, and what is known beforehand of the lens and the mesh, in one least squares
// (turntable_equations.h says of which unknowns).
//
// Starts from the rig's description; where the mesh does not lie as described, single views are searched and the
// placement that fits all views best is taken. What the views do not determine together is reported, as in
// register_view.h; tags do not determine it either, for they do not see the mesh.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "processing/calibration/pose/register_view.h"
#include "processing/calibration/pose/turntable_start.h"
#include "rig/rig_description.h"

namespace lumitexel {

// Corners in the order of TagDescription::corners().
struct TagObservation {
  int tag_id = 0;
  std::size_t view = 0;
  std::array<Eigen::Vector2d, 4> corners_px;
  double sigma_px = 0;  // of a corner, per axis
};

struct TurntableOptions {
  SearchRange search;                  // how far the mesh may be from its start; zeros: within some pixels
  double angle_sigma_deg = 0;          // of an angle as read back; 0: exact
  std::optional<LensMatrix> lens_covariance;  // prior; none: the lens is exact
  std::optional<RimModel> model;       // none: the one that fits better
  std::size_t rim_points = 10000;      // over all views
  double least_turn_share = 0.012;     // see ViewRegistrationOptions
};

// Shares of the variance of a view's shift, summing to 1.
struct VarianceShares {
  double contour = 0, tags = 0, lens = 0, angles = 0, mesh = 0;
  const char* dominant() const;  // the name of the largest
};

struct RegisteredView {
  Eigen::Isometry3d camera_from_mesh = Eigen::Isometry3d::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();  // of a PoseStep about the mesh's middle
  double sigma_m = 0, sigma_deg = 0;                   // as in ViewRegistration
  double silhouette_px = 0, explained = 0;             // median distance; share of the outline on the contour
  double tag_rms_px = 0;
  VarianceShares shares;
  Eigen::MatrixXd by_unknowns;  // derivatives of the PoseStep by all unknowns
  void state(const PoseCovariance& of_pose);  // covariance, sigma_m and sigma_deg
};

struct TurntableRegistration {
  bool converged = false;
  std::string problem;
  std::vector<RegisteredView> views;
  TurntableModel model;
  TurntableUnknowns unknowns{false, false, false, 0};
  Eigen::MatrixXd covariance;  // of all unknowns
  RimModel rim = RimModel::Smooth;
  double independent = 0;  // contour points that say as much as all correlated ones
  std::vector<PoseAmbiguity> ambiguities;
  bool ambiguous() const { return !ambiguities.empty(); }
};

// Observations of tags that are not on the table or not described are left out. Throws BadInput for no views, an index
// that is none, an angle or sigma that is not finite or negative, or a start with the object behind the camera.
TurntableRegistration register_turntable(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                         const TurntableStart& start, const std::vector<TagDescription>& tags,
                                         const std::vector<TagObservation>& observations,
                                         const TurntableOptions& options = {});

}  // namespace lumitexel
