// The equations of a turntable's views in one least squares: silhouettes, tags, and what is known beforehand.
//
// Its unknowns are those of turntable_equations.h; a contour's residual is in pixels along the normal, a corner's in pixels.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/pose/contour_lookup.h"
#include "processing/calibration/pose/mesh_silhouette.h"
#include "processing/calibration/pose/residual_correlation.h"
#include "processing/calibration/pose/silhouette_equations.h"
#include "processing/calibration/pose/turntable_equations.h"

namespace lumitexel {

struct TurntableView {
  const ContourLookup* contour = nullptr;  // null: a view with tags only
  double angle_deg = 0;                    // of the table, as read back
};

struct TagCorner {
  std::size_t view = 0;
  Eigen::Vector3d x_in_table;
  Eigen::Vector2d pixel;
  double sigma_px = 0;  // per axis
};

// What is known before the views say anything.
struct TurntablePriors {
  CameraModel camera;                         // the lens's
  std::optional<LensMatrix> lens_covariance;  // none: the lens is exact
  double angle_sigma_deg = 0;                 // of an angle as read back; 0: exact
};

// What each source says about the unknowns; gradient: of all together, downhill.
struct TurntableInformation {
  Eigen::MatrixXd contour, tags, lens, angles, mesh;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd sum() const { return contour + tags + lens + angles + mesh; }
};

// How much each source counts.
struct TurntableWeights {
  double scale_px = 1;       // contour points farther off than this count less
  double per_px = 1;         // of a pixel of contour, in 1/px^2
  double swell_sigma_m = 1;  // how far the surface may be off the mesh all around
  double tag_floor_px = 0;   // far from the solution corners may be off by this; shrinks with the contours' scale
};

class TurntableProblem {
 public:
  // Keeps references to mesh and views.
  TurntableProblem(const MeshSilhouette& mesh, const std::vector<TurntableView>& views, std::vector<TagCorner> corners,
                   const TurntablePriors& priors);

  const TurntableUnknowns unknowns;

  double angle_rad(const TurntableModel& model, std::size_t view) const;
  CentredPose pose(const TurntableModel& model, std::size_t view) const { return pose_at(model, angle_rad(model, view)); }
  std::vector<SilhouetteEquations> silhouettes(const TurntableModel& model, double reach_px, double spacing_px,
                                               RimModel rim) const;
  TurntableInformation information(const TurntableModel& model, const std::vector<SilhouetteEquations>& silhouettes,
                                   const TurntableWeights& weights) const;
  // Rows over all unknowns, for their correlation.
  WeightedResiduals weighted_rows(const TurntableModel& model, const std::vector<SilhouetteEquations>& silhouettes,
                                  double scale_px) const;
  double tag_rms_px(const TurntableModel& model, std::size_t view) const;

 private:
  void add_corner(const TurntableModel& model, const TagCorner& corner, double floor_px, TurntableInformation& all) const;
  void add_priors(const TurntableModel& model, double swell_sigma_m, TurntableInformation& all) const;

  const MeshSilhouette& mesh_;
  const std::vector<TurntableView>& views_;
  std::vector<TagCorner> corners_;
  TurntablePriors priors_;
  LensMatrix lens_information_ = LensMatrix::Zero();
};

}  // namespace lumitexel
