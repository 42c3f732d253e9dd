#include "processing/calibration/pose/turntable_problem.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

using U = TurntableUnknowns;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kTagScale = 4.0;  // standard deviations; a misread corner is farther off

Eigen::Matrix<double, 15, 1> local_row(const SilhouetteEquation& row) {
  Eigen::Matrix<double, 15, 1> j;
  j << row.by_pose.transpose(), row.by_swell, row.by_lens.transpose();
  return j;
}

}  // namespace

TurntableProblem::TurntableProblem(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                   std::vector<TagCorner> corners, const TurntablePriors& priors)
    : unknowns(!corners.empty(), priors.lens_covariance.has_value(), priors.angle_sigma_deg > 0.0, views.size()),
      mesh_(mesh), views_(views), corners_(std::move(corners)), priors_(priors) {
  if (priors.lens_covariance) lens_information_ = lens_prior_information(*priors.lens_covariance);
}

double TurntableProblem::angle_rad(const TurntableModel& model, std::size_t view) const {
  return views_[view].angle_deg * kRadPerDeg + model.angle_offset_rad[view];
}

std::vector<SilhouetteEquations> TurntableProblem::silhouettes(const TurntableModel& model, double reach_px, double spacing_px,
                                             RimModel rim) const {
  std::vector<SilhouetteEquations> all(views_.size());
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (views_[v].contour == nullptr) continue;
    all[v] = silhouette_equations(mesh_, *views_[v].contour, model.camera, pose(model, v), reach_px, spacing_px, rim);
    for (SilhouetteEquation& row : all[v].rows) row.distance_px -= model.swell_m * row.by_swell;
  }
  return all;
}

TurntableInformation TurntableProblem::information(const TurntableModel& model,
                                                   const std::vector<SilhouetteEquations>& silhouettes,
                                                   const TurntableWeights& weights) const {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(unknowns.count, unknowns.count);
  TurntableInformation all{none, none, none, none, none, Eigen::VectorXd::Zero(unknowns.count)};
  for (std::size_t v = 0; v < views_.size(); ++v) {
    Eigen::Matrix<double, 15, 15> local = Eigen::Matrix<double, 15, 15>::Zero();
    Eigen::Matrix<double, 15, 1> right = Eigen::Matrix<double, 15, 1>::Zero();
    for (const SilhouetteEquation& row : silhouettes[v].rows) {
      const Eigen::Matrix<double, 15, 1> j = local_row(row);
      const double w = weights.per_px * row.length_px * robust_weight(row.distance_px, weights.scale_px);
      local += w * j * j.transpose();
      right += w * row.distance_px * j;
    }
    const Eigen::MatrixXd d = view_derivatives(model, unknowns, v, angle_rad(model, v));
    all.contour += d.transpose() * local * d;
    all.gradient += d.transpose() * right;
  }
  for (const TagCorner& corner : corners_) add_corner(model, corner, weights.tag_floor_px, all);
  add_priors(model, weights.swell_sigma_m, all);
  return all;
}

WeightedResiduals TurntableProblem::weighted_rows(const TurntableModel& model, const std::vector<SilhouetteEquations>& silhouettes,
                                double scale_px) const {
  std::size_t count = 0;
  for (const SilhouetteEquations& one : silhouettes) count += one.rows.size();
  const auto rows = static_cast<Eigen::Index>(count);
  WeightedResiduals all{{}, Eigen::VectorXd(rows), Eigen::VectorXd(rows), Eigen::MatrixXd(rows, unknowns.count)};
  Eigen::Index i = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const Eigen::MatrixXd d = view_derivatives(model, unknowns, v, angle_rad(model, v));
    for (const SilhouetteEquation& row : silhouettes[v].rows) {
      all.x_in_mesh.push_back(row.x_in_mesh);
      all.residual[i] = row.distance_px;
      all.weight[i] = row.length_px * robust_weight(row.distance_px, scale_px);
      all.jacobian.row(i++) = local_row(row).transpose() * d;
    }
  }
  return all;
}

double TurntableProblem::tag_rms_px(const TurntableModel& model, std::size_t view) const {
  double sum = 0.0;
  int count = 0;
  for (const TagCorner& corner : corners_) {
    if (corner.view != view) continue;
    const Eigen::Vector3d x = pose(model, view).in_camera(model.mesh_from_table * corner.x_in_table);
    sum += (model.camera.project(x) - corner.pixel).squaredNorm();
    count += 2;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

void TurntableProblem::add_corner(const TurntableModel& model, const TagCorner& corner, double floor_px,
                                  TurntableInformation& all) const {
  const CentredPose view_pose = pose(model, corner.view);
  const Eigen::Vector3d from_centre = model.mesh_from_table * corner.x_in_table - view_pose.centre;
  const Eigen::Vector3d arm = view_pose.rotation * from_centre, x = arm + view_pose.centre_in_camera;
  if (!(x.z() > 0.0)) return;
  const ProjectedPoint projected = project_with_derivatives(model.camera, x);
  Eigen::Matrix<double, 2, 15> local = Eigen::Matrix<double, 2, 15>::Zero();
  local.leftCols<3>() = -projected.by_point * cross_matrix(arm);
  local.middleCols<3>(3) = projected.by_point;
  local.rightCols<8>() = projected.by_lens;
  Eigen::MatrixXd j = local * view_derivatives(model, unknowns, corner.view, angle_rad(model, corner.view));
  const Eigen::Matrix<double, 2, 3> by_mesh_point = projected.by_point * view_pose.rotation;
  j.middleCols<3>(unknowns.tags) -= by_mesh_point * cross_matrix(from_centre);
  j.middleCols<3>(unknowns.tags + 3) += by_mesh_point;
  const Eigen::Vector2d off = corner.pixel - projected.pixel;
  const double w = robust_weight(off.norm(), kTagScale * std::max(corner.sigma_px, floor_px)) / (corner.sigma_px * corner.sigma_px);
  all.tags += w * j.transpose() * j;
  all.gradient += w * j.transpose() * off;
}

void TurntableProblem::add_priors(const TurntableModel& model, double swell_sigma_m, TurntableInformation& all) const {
  const double swell = 1.0 / (swell_sigma_m * swell_sigma_m);
  all.mesh(U::kSwell, U::kSwell) = swell;
  all.gradient[U::kSwell] -= swell * model.swell_m;
  if (unknowns.lens >= 0) {
    const LensVector off = lens_vector(model.camera) - lens_vector(priors_.camera);
    all.lens.block<8, 8>(unknowns.lens, unknowns.lens) = lens_information_;
    all.gradient.segment<8>(unknowns.lens) -= lens_information_ * off;
  }
  if (unknowns.angles < 0) return;
  const double angle = 1.0 / std::pow(priors_.angle_sigma_deg * kRadPerDeg, 2);
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const Eigen::Index k = unknowns.angles + static_cast<Eigen::Index>(v);
    all.angles(k, k) = angle;
    all.gradient[k] -= angle * model.angle_offset_rad[v];
  }
}

}  // namespace lumitexel
