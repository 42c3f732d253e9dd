#include "processing/calibration/pose/register_turntable.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "drivers/error.h"
#include "processing/calibration/pose/residual_correlation.h"
#include "processing/calibration/pose/turntable_fit.h"

namespace lumitexel {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kCorrelationReach = 0.4;  // as in register_view.cpp
constexpr double kLeastExplained = 0.5;
constexpr double kClearlyBetter = 0.9;  // facets instead of a smooth surface

// The information on the first view's pose that is left when all else is free.
PoseCovariance reduced_to_pose(const Eigen::MatrixXd& information) {
  const Eigen::Index rest = information.rows() - 6;
  const Eigen::VectorXd scale = information.diagonal().tail(rest).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd others = scale.asDiagonal() * information.bottomRightCorner(rest, rest) * scale.asDiagonal();
  others.diagonal().array() += 1e-9;
  const Eigen::MatrixXd mixed = information.topRightCorner(6, rest) * scale.asDiagonal();
  return information.topLeftCorner<6, 6>() - mixed * others.ldlt().solve(Eigen::MatrixXd(mixed.transpose()));
}

std::vector<TagCorner> corners_of(const std::vector<TagDescription>& tags, const std::vector<TagObservation>& observations,
                                  std::size_t views) {
  std::vector<TagCorner> corners;
  for (const TagObservation& seen : observations) {
    if (seen.view >= views) throw BadInput("tag observation", "view " + std::to_string(seen.view), "one of the views");
    if (!(seen.sigma_px > 0.0) || !std::isfinite(seen.sigma_px))
      throw BadInput("tag observation", "sigma_px " + std::to_string(seen.sigma_px), "a positive number");
    for (const TagDescription& tag : tags) {
      if (tag.id != seen.tag_id || !tag.on_table) continue;
      const std::array<Eigen::Vector3d, 4> x = tag.corners();
      for (std::size_t k = 0; k < 4; ++k) {
        if (!seen.corners_px[k].allFinite()) throw BadInput("tag observation", "a corner that is not finite", "pixels");
        corners.push_back({seen.view, x[k], seen.corners_px[k], seen.sigma_px});
      }
    }
  }
  return corners;
}

void check(const std::vector<TurntableView>& views, const TurntableStart& start, const MeshSilhouette& mesh,
           const TurntableOptions& options) {
  if (views.empty()) throw BadInput("turntable", "no views", "at least one");
  for (const TurntableView& view : views) {
    if (!std::isfinite(view.angle_deg)) throw BadInput("turntable", "an angle that is not finite", "degrees");
  }
  if (!(options.angle_sigma_deg >= 0.0)) throw BadInput("turntable", "a negative angle_sigma_deg", "0 or more");
  const Eigen::Vector3d centre = start.camera_from_table * start.table_from_mesh * mesh.extent().centre;
  if (!centre.allFinite() || !(centre.z() > 0.0))
    throw BadInput("turntable", "a start with the object behind the camera", "the object in front of it");
}

const TurntableModel& best_start(const TurntableProblem& problem, const std::vector<TurntableModel>& starts, double scale_px,
                                 double spacing_px, RimModel rim) {
  const TurntableModel* best = &starts[0];
  double most = -1.0;
  for (const TurntableModel& model : starts) {
    const double explained = explained_by(problem.silhouettes(model, 4.0 * scale_px, spacing_px, rim), scale_px);
    if (explained <= most) continue;
    most = explained;
    best = &model;
  }
  return *best;
}

// The fit at full detail, with the surface model that fits better; `fine` says how it was made.
TurntableFit fit_from(const TurntableProblem& problem, const std::vector<TurntableModel>& starts, double px_per_m,
                      double radius_px, const TurntableOptions& options, TurntableFitOptions& fine) {
  const double coarse_px = starts.size() > 1 ? radius_px / 10.0 : 10.0;
  fine.rim = options.model.value_or(RimModel::Smooth);
  const TurntableModel& start = best_start(problem, starts, coarse_px, radius_px / 20.0, fine.rim);
  TurntableFit fit = fit_turntable(problem, start, px_per_m, {coarse_px, std::max(2.0, radius_px / 30.0), fine.rim, 1.0, 25});
  double outline_px = 0.0;
  for (const SilhouetteEquations& one : fit.silhouettes) outline_px += one.outline_px;
  fine.start_scale_px = std::max(3.0, fit.weights.scale_px);
  fine.spacing_px = std::max(1.0, outline_px / static_cast<double>(options.rim_points));
  fit = fit_turntable(problem, fit.model, px_per_m, fine);
  if (options.model) return fit;
  TurntableFitOptions facets = fine;
  facets.rim = RimModel::Facets;
  facets.start_scale_px = 3.0;
  const TurntableFit other = fit_turntable(problem, fit.model, px_per_m, facets);
  if (other.sigma_px < kClearlyBetter * fit.sigma_px && other.explained >= 0.98 * fit.explained) {
    fit = other;
    fine.rim = RimModel::Facets;
  }
  return fit;
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd unit = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = unit.asDiagonal() * information * unit.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(information.rows(), information.cols());
  return unit.asDiagonal() * scaled.ldlt().solve(identity) * unit.asDiagonal();
}

// Of all unknowns, by what each part of it comes from.
struct CovarianceParts {
  Eigen::MatrixXd contour, tags, lens, angles, mesh;
  Eigen::MatrixXd sum() const { return contour + tags + lens + angles + mesh; }
};

RegisteredView registered_view(const TurntableProblem& problem, const TurntableFit& fit, const CovarianceParts& parts,
                               std::size_t v) {
  RegisteredView view;
  view.camera_from_mesh = problem.pose(fit.model, v).camera_from_mesh();
  view.by_unknowns = view_derivatives(fit.model, problem.unknowns, v, problem.angle_rad(fit.model, v)).topRows(6);
  view.state(view.by_unknowns * parts.sum() * view.by_unknowns.transpose());
  const Eigen::MatrixXd shift = view.by_unknowns.bottomRows(3);
  const double total = view.sigma_m * view.sigma_m;
  const auto share = [&](const Eigen::MatrixXd& part) { return (shift * part * shift.transpose()).trace() / total; };
  view.shares = {share(parts.contour), share(parts.tags), share(parts.lens), share(parts.angles), share(parts.mesh)};
  view.silhouette_px = median_distance_px(fit.silhouettes[v].rows);
  view.explained = explained_share(fit.silhouettes[v], fit.weights.scale_px);
  view.tag_rms_px = problem.tag_rms_px(fit.model, v);
  return view;
}

std::string problem_of(const TurntableFit& fit, const TurntableRegistration& result) {
  if (fit.explained <= kLeastExplained) return "most of the mesh's outline lies on no contour";
  if (result.ambiguous()) return "the silhouettes do not determine the turn about an axis of the mesh";
  return fit.converged ? "" : "no convergence";
}

}  // namespace

const char* VarianceShares::dominant() const {
  const std::array<std::pair<double, const char*>, 5> all{
      {{contour, "contour"}, {tags, "tags"}, {lens, "lens"}, {angles, "angles"}, {mesh, "mesh"}}};
  return std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; })->second;
}

void RegisteredView::state(const PoseCovariance& of_pose) {
  covariance = of_pose;
  sigma_deg = std::sqrt(covariance.topLeftCorner<3, 3>().trace()) / kRadPerDeg;
  sigma_m = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
}

TurntableRegistration register_turntable(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                         const TurntableStart& start, const std::vector<TagDescription>& tags,
                                         const std::vector<TagObservation>& observations, const TurntableOptions& options) {
  check(views, start, mesh, options);
  const TurntableProblem problem(mesh, views, corners_of(tags, observations, views.size()),
                                 {start.camera, options.lens_covariance, options.angle_sigma_deg});
  const std::vector<TurntableModel> starts =
      turntable_starts(mesh, views, start, options.search, options.model.value_or(RimModel::Smooth));
  const double px_per_m = focal_px(start.camera) / starts[0].camera_from_mesh.centre_in_camera.z();
  TurntableFitOptions fine;
  TurntableFit fit = fit_from(problem, starts, px_per_m, mesh.extent().radius_m * px_per_m, options, fine);
  TurntableRegistration result;
  result.unknowns = problem.unknowns;
  result.rim = fine.rim;
  if (all_rows(fit.silhouettes).size() < kLeastRows) {
    result.problem = "no contours within reach of the mesh's outline";
    return result;
  }
  // Correlated contour errors weigh less against tags and priors than their number says: once more with that weight.
  const double reach_m = kCorrelationReach * mesh.extent().radius_m;
  WeightedResiduals rows = problem.weighted_rows(fit.model, fit.silhouettes, fit.weights.scale_px);
  const double shared_sq = kSharedError_px * kSharedError_px / static_cast<double>(views.size());
  fine.correlation = std::max(1.0, rows.weight.sum() * (1.0 / correlated_scores(rows, reach_m).independent +
                                                        shared_sq / std::pow(std::max(fit.sigma_px, 0.02), 2)));
  fine.start_scale_px = fit.weights.scale_px;
  fit = fit_turntable(problem, fit.model, px_per_m, fine);
  rows = problem.weighted_rows(fit.model, fit.silhouettes, fit.weights.scale_px);
  const FitCovariance scores = correlated_scores(rows, reach_m);
  const TurntableInformation all = problem.information(fit.model, fit.silhouettes, fit.weights);
  const double per_px = fit.weights.per_px, weight = rows.weight.sum();
  const Eigen::MatrixXd bread = inverse_of(all.sum()), shared = shared_sq * weight * per_px * all.contour;
  const auto between = [&](const Eigen::MatrixXd& meat) -> Eigen::MatrixXd { return bread * meat * bread; };
  const CovarianceParts parts{between(per_px * per_px * scores.meat + shared), between(all.tags), between(all.lens),
                              between(all.angles), between(all.mesh)};
  for (std::size_t v = 0; v < views.size(); ++v) result.views.push_back(registered_view(problem, fit, parts, v));
  result.covariance = parts.sum();
  result.model = fit.model;
  result.independent = scores.independent;
  // Tags tell camera and axis, so what they say counts too, for all but the mesh's own turn on the table.
  result.ambiguities = undetermined_turns(reduced_to_pose(all.sum() / (per_px * weight)), fit.model.camera_from_mesh.rotation,
                                          mesh.extent().radius_m, px_per_m, options.least_turn_share);
  result.converged = fit.converged && fit.explained > kLeastExplained;
  result.problem = problem_of(fit, result);
  return result;
}

}  // namespace lumitexel
