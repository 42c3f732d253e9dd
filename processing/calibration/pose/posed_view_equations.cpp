#include "processing/calibration/pose/posed_view_equations.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "processing/calibration/pose/pose_search.h"

namespace lumitexel {
namespace {

constexpr double kLensFocal = 0.05, kLensPrincipal = 0.05;  // a given lens is right to so much, of focal length and width

}  // namespace

CameraModel with_shared_lens(const CameraModel& camera, const Eigen::Vector3d& step) {
  CameraModel c = camera;
  c.focal_x_px *= 1.0 + step[0];
  c.focal_y_px *= 1.0 + step[0];
  c.principal_x_px += step[1];
  c.principal_y_px += step[2];
  return c;
}

PosedViewEquations::PosedViewEquations(const MeshSilhouette& mesh, const std::vector<PosedView>& views, bool with_lens,
                                       double rim_offset_sigma_px)
    : mesh_(mesh), views_(views), with_lens_(with_lens), rim_offset_sigma_px_(rim_offset_sigma_px) {}

PosedViewsState PosedViewEquations::given() const {
  PosedViewsState state;
  for (const PosedView& view : views_) state.poses.emplace_back(view.camera_from_mesh, mesh_.extent().centre);
  return state;
}

std::vector<PoseStep> PosedViewEquations::from_given(const PosedViewsState& state) const {
  std::vector<PoseStep> steps;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const CentredPose given(views_[v].camera_from_mesh, mesh_.extent().centre);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(state.poses[v].rotation * given.rotation.transpose()));
    PoseStep step;
    step << turn.angle() * turn.axis(), state.poses[v].centre_in_camera - given.centre_in_camera;
    steps.push_back(step);
  }
  return steps;
}

void PosedViewEquations::move(PosedViewsState& state, const PosedViewSolution& solution) const {
  for (std::size_t v = 0; v < views_.size(); ++v) state.poses[v] = state.poses[v].moved(solution.steps[v]);
  state.rim_offset_px += solution.shared_step[0];
  if (with_lens_) state.lens += solution.shared_step.tail<3>();
}

double PosedViewEquations::px_per_m(std::size_t v) const {
  return focal_px(views_[v].camera) / (views_[v].camera_from_mesh * mesh_.extent().centre).z();
}

double PosedViewEquations::size_px(std::size_t v, const PoseStep& step) const {
  return px_per_m(v) * std::hypot(mesh_.extent().radius_m * step.head<3>().norm(), step.tail<3>().norm());
}

std::vector<SilhouetteEquations> PosedViewEquations::silhouettes(const PosedViewsState& state, double reach_px, double spacing_px,
                                                                 RimModel rim) const {
  std::vector<SilhouetteEquations> all(views_.size());
  tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t v) {
    if (views_[v].contour == nullptr) return;
    all[v] = silhouette_equations(mesh_, *views_[v].contour, with_shared_lens(views_[v].camera, state.lens), state.poses[v], reach_px,
                                  spacing_px, rim);
    for (SilhouetteEquation& row : all[v].rows) row.distance_px -= state.rim_offset_px;
  });
  return all;
}

Eigen::VectorXd PosedViewEquations::by_shared(std::size_t v, const SilhouetteEquation& row) const {
  Eigen::VectorXd by(shared_unknowns());
  by[0] = 1.0;
  if (!with_lens_) return by;
  const CameraModel& camera = views_[v].camera;
  by[1] = row.by_lens[0] * camera.focal_x_px + row.by_lens[1] * camera.focal_y_px;
  by.tail<2>() = row.by_lens.segment<2>(2).transpose();
  return by;
}

Eigen::VectorXd PosedViewEquations::shared_prior() const {
  Eigen::VectorXd information(shared_unknowns());
  information[0] = std::pow(rim_offset_sigma_px_, -2);
  if (!with_lens_) return information;
  const double principal_px = kLensPrincipal * views_[0].camera.width_px;
  information.tail<3>() << std::pow(kLensFocal, -2), std::pow(principal_px, -2), std::pow(principal_px, -2);
  return information;
}

PosedViewSystem PosedViewEquations::system(const PosedViewsState& state, const std::vector<SilhouetteEquations>& silhouettes,
                                           double scale_px, double per_px) const {
  PosedViewSystem all(views_.size(), shared_unknowns());
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const SilhouetteEquation& row : silhouettes[v].rows) {
      const double w = per_px * row.length_px * robust_weight(row.distance_px, scale_px);
      const PoseStep j = row.by_pose.transpose();
      const Eigen::VectorXd shared = by_shared(v, row);
      all.own[v] += w * j * j.transpose();
      all.mixed[v] += w * j * shared.transpose();
      all.score[v] += w * row.distance_px * j;
      all.shared += w * shared * shared.transpose();
      all.shared_score += w * row.distance_px * shared;
    }
  }
  const Eigen::VectorXd prior = shared_prior();
  Eigen::VectorXd at(shared_unknowns());
  at[0] = state.rim_offset_px;
  if (with_lens_) at.tail<3>() = state.lens;
  all.shared.diagonal() += prior;
  all.shared_score -= prior.cwiseProduct(at);
  return all;
}

WeightedResiduals PosedViewEquations::rows(const std::vector<SilhouetteEquations>& silhouettes, double scale_px) const {
  std::size_t count = 0;
  for (const SilhouetteEquations& one : silhouettes) count += one.rows.size();
  const auto rows = static_cast<Eigen::Index>(count), poses = 6 * static_cast<Eigen::Index>(views_.size());
  WeightedResiduals all{{}, Eigen::VectorXd(rows), Eigen::VectorXd(rows), Eigen::MatrixXd::Zero(rows, poses + shared_unknowns())};
  Eigen::Index i = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const SilhouetteEquation& row : silhouettes[v].rows) {
      all.x_in_mesh.push_back(row.x_in_mesh);
      all.residual[i] = row.distance_px;
      all.weight[i] = row.length_px * robust_weight(row.distance_px, scale_px);
      all.jacobian.row(i).segment<6>(6 * static_cast<Eigen::Index>(v)) = row.by_pose;
      all.jacobian.row(i++).tail(shared_unknowns()) = by_shared(v, row).transpose();
    }
  }
  return all;
}

}  // namespace lumitexel
