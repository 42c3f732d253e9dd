// Contour distances of many posed views as one linear system: a pose each, and what they share.
#pragma once

#include <vector>

#include "processing/calibration/pose/contour_lookup.h"
#include "processing/calibration/pose/mesh_silhouette.h"
#include "processing/calibration/pose/posed_view_system.h"
#include "processing/calibration/pose/residual_correlation.h"
#include "processing/calibration/pose/silhouette_equations.h"

namespace lumitexel {

struct PosedView {
  const ContourLookup* contour = nullptr;  // null: nothing was seen, the given pose stays
  CameraModel camera;
  Eigen::Isometry3d camera_from_mesh = Eigen::Isometry3d::Identity();  // as given
};

// The camera with focal lengths times (1 + step[0]), principal point moved by step[1], step[2] pixels.
CameraModel with_shared_lens(const CameraModel& camera, const Eigen::Vector3d& step);

struct PosedViewsState {
  std::vector<CentredPose> poses;
  double rim_offset_px = 0;  // by which contours lie outside of the mesh's outline
  Eigen::Vector3d lens = Eigen::Vector3d::Zero();
};

class PosedViewEquations {
 public:
  // Shared unknowns: the rim's offset, with lens three more. The priors' sigmas are of the shared unknowns.
  PosedViewEquations(const MeshSilhouette& mesh, const std::vector<PosedView>& views, bool with_lens, double rim_offset_sigma_px);

  Eigen::Index shared_unknowns() const { return with_lens_ ? 4 : 1; }
  PosedViewsState given() const;
  std::vector<PoseStep> from_given(const PosedViewsState& state) const;
  void move(PosedViewsState& state, const PosedViewSolution& solution) const;
  // Pixels that a step of view v moves points of the object by.
  double size_px(std::size_t v, const PoseStep& step) const;
  double px_per_m(std::size_t v) const;
  const MeshSilhouette& mesh() const { return mesh_; }

  // One a view; distances are less the rim's offset.
  std::vector<SilhouetteEquations> silhouettes(const PosedViewsState& state, double reach_px, double spacing_px, RimModel rim) const;
  // per_px: the weight of a pixel of contour, in 1/px^2.
  PosedViewSystem system(const PosedViewsState& state, const std::vector<SilhouetteEquations>& silhouettes, double scale_px,
                         double per_px) const;
  // Every view's six unknowns in the order of the views, then the shared ones.
  WeightedResiduals rows(const std::vector<SilhouetteEquations>& silhouettes, double scale_px) const;
  Eigen::VectorXd shared_prior() const;  // information, its diagonal

 private:
  Eigen::VectorXd by_shared(std::size_t v, const SilhouetteEquation& row) const;

  const MeshSilhouette& mesh_;
  const std::vector<PosedView>& views_;
  bool with_lens_;
  double rim_offset_sigma_px_;
};

}  // namespace lumitexel
