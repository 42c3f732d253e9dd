#include "processing/calibration/pose/register_posed_views.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "drivers/error.h"
#include "processing/calibration/pose/residual_correlation.h"

namespace lumitexel {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kCorrelationReach = 0.4;  // as in register_view.cpp
constexpr double kLeastExplained = 0.5;
constexpr double kClearlyBetter = 0.9;  // facets instead of a smooth surface
constexpr double kStartScale_px = 10.0;
constexpr std::size_t kLeastRows = 20;
// A coarse mesh errs in the same way wherever it is seen (smoothing takes from all its ridges), so this share of the contours' scatter does
// not average out over views in what they share.
constexpr double kSystematic = 0.1;
constexpr int kIterations = 40, kRounds = 30;
constexpr double kSettledOfSigma = 0.2;  // a mask's coarse rim keeps poses moving by more than settled_px, but by no more than this matters

struct JointFit {
  PosedViewsState state;
  std::vector<SilhouetteEquations> silhouettes;
  PosedViewSystem system{0, 1};
  PoseSpread spread{0.02, 0.01, 0.01}, upper{0.02, 0.01, 0.01};
  double scale_px = kStartScale_px, sigma_px = 0, per_px = 1, correlation = 1, spacing_px = 1;
  RimModel rim = RimModel::Smooth;
  std::size_t rows = 0;
  bool converged = false;
};

std::vector<SilhouetteEquation> all_rows(const std::vector<SilhouetteEquations>& silhouettes) {
  std::vector<SilhouetteEquation> rows;
  for (const SilhouetteEquations& one : silhouettes) rows.insert(rows.end(), one.rows.begin(), one.rows.end());
  return rows;
}

double explained_by(const JointFit& fit) {
  double sum = 0.0, length = 0.0;
  for (const SilhouetteEquations& one : fit.silhouettes) {
    sum += explained_share(one, fit.scale_px) * one.outline_px;
    length += one.outline_px;
  }
  return length > 0.0 ? sum / length : 0.0;
}

double outline_px(const std::vector<SilhouetteEquations>& silhouettes) {
  return std::accumulate(silhouettes.begin(), silhouettes.end(), 0.0,
                         [](double sum, const SilhouetteEquations& one) { return sum + one.outline_px; });
}

// Steps in units of their own sigma, rms over views and components.
double rms_of_sigma(const PosedViewSolution& solution) {
  double sum = 0.0;
  for (std::size_t v = 0; v < solution.steps.size(); ++v) {
    sum += solution.steps[v].cwiseAbs2().cwiseQuotient(solution.covariance[v].diagonal()).sum();
  }
  return std::sqrt(sum / (6.0 * static_cast<double>(solution.steps.size())));
}

// The scale of the robust weights shrinks to the residuals' own as in refine_pose; only then do they tell the given poses' spread.
JointFit refine(const PosedViewEquations& equations, JointFit fit) {
  double scale_px = fit.scale_px, last_px = 1e300, last_of_sigma = 1e300;
  for (int iteration = 0;; ++iteration) {
    fit.silhouettes = equations.silhouettes(fit.state, 4.0 * scale_px, fit.spacing_px, fit.rim);
    const std::vector<SilhouetteEquation> rows = all_rows(fit.silhouettes);
    fit.rows = rows.size();
    fit.sigma_px = robust_sigma_px(rows);
    const double own_px = std::max(3.0 * fit.sigma_px, kLeastScale_px);
    const bool shrunk = scale_px <= own_px * 1.001;
    fit.scale_px = shrunk ? own_px : std::max(own_px, 0.6 * scale_px);
    if (!shrunk) scale_px = fit.scale_px;
    fit.per_px = 1.0 / (std::pow(std::max(fit.sigma_px, 0.02), 2) * fit.correlation);
    fit.system = equations.system(fit.state, fit.silhouettes, fit.scale_px, fit.per_px);
    fit.converged = shrunk && (last_px < settled_px(fit.scale_px) || last_of_sigma < kSettledOfSigma);
    if (fit.converged || iteration == kIterations || fit.rows < kLeastRows) return fit;
    const std::vector<PoseStep> from_given = equations.from_given(fit.state);
    if (shrunk) {
      fit.spread = likeliest_spread(fit.system, fit.spread, from_given, kRounds);
      fit.upper = upper_spread(fit.system, fit.spread);
    }
    const PosedViewSolution solution = solve(fit.system, fit.upper, from_given);
    double squared_px = 0.0;
    for (std::size_t v = 0; v < from_given.size(); ++v) squared_px += std::pow(equations.size_px(v, solution.steps[v]), 2);
    last_px = std::sqrt(squared_px / static_cast<double>(from_given.size()));
    last_of_sigma = rms_of_sigma(solution);
    if (!std::isfinite(last_px)) return fit;
    equations.move(fit.state, solution);
  }
}

double correlation_of(const PosedViewEquations& equations, const JointFit& fit) {
  WeightedResiduals rows = equations.rows(fit.silhouettes, fit.scale_px);
  rows.jacobian = Eigen::MatrixXd::Ones(rows.residual.size(), 1);  // not asked for
  return std::max(1.0, rows.weight.sum() / correlated_scores(rows, kCorrelationReach * equations.mesh().extent().radius_m).independent);
}

// One fit with independent contour errors, and one more with the weight that is left to them by their correlation.
JointFit fit_views(const PosedViewEquations& equations, const PosedViewsOptions& options) {
  JointFit fit;
  fit.state = equations.given();
  fit.rim = options.model.value_or(RimModel::Smooth);
  const double coarse_px = std::max(2.0, 0.05 * equations.mesh().extent().radius_m * equations.px_per_m(0));
  const double length_px = outline_px(equations.silhouettes(fit.state, 4.0 * kStartScale_px, coarse_px, fit.rim));
  fit.spacing_px = std::max(1.0, length_px / static_cast<double>(options.rim_points));
  fit = refine(equations, fit);
  if (!options.model && fit.rows >= kLeastRows) {
    JointFit facets = fit;
    facets.scale_px = 3.0;
    facets.rim = RimModel::Facets;
    facets = refine(equations, facets);
    if (facets.sigma_px < kClearlyBetter * fit.sigma_px && explained_by(facets) >= 0.98 * explained_by(fit)) fit = facets;
  }
  if (fit.rows < kLeastRows) return fit;
  fit.correlation = correlation_of(equations, fit);
  return refine(equations, fit);
}

// Covariances of all unknowns, by what they come from.
struct PosedCovariance {
  Eigen::MatrixXd contour, given, rim, meat;  // the last: of the scores, from the contour
  double independent = 0;
  Eigen::MatrixXd sum() const { return contour + given + rim; }
};

PosedCovariance covariance_of(const PosedViewEquations& equations, const JointFit& fit) {
  const WeightedResiduals rows = equations.rows(fit.silhouettes, fit.scale_px);
  const FitCovariance scores = correlated_scores(rows, kCorrelationReach * equations.mesh().extent().radius_m);
  const Eigen::Index views = static_cast<Eigen::Index>(fit.system.own.size()), shared = equations.shared_unknowns(),
                     count = 6 * views + shared;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd given = Eigen::VectorXd::Zero(count), rim = Eigen::VectorXd::Zero(count);
  PosedCovariance all;
  all.independent = scores.independent;
  all.meat = fit.per_px * fit.per_px * scores.meat;
  for (Eigen::Index v = 0; v < views; ++v) {
    const auto k = static_cast<std::size_t>(v);
    information.block<6, 6>(6 * v, 6 * v) = fit.system.own[k];
    information.block(6 * v, 6 * views, 6, shared) = fit.system.mixed[k];
    information.block(6 * views, 6 * v, shared, 6) = fit.system.mixed[k].transpose();
    given.segment<6>(6 * v) = fit.upper.information();
    double length = 0.0;
    for (const SilhouetteEquation& row : fit.silhouettes[k].rows) {
      length += row.length_px * robust_weight(row.distance_px, fit.scale_px);
    }
    all.meat.block<6, 6>(6 * v, 6 * v) += kSharedError_px * kSharedError_px * fit.per_px * length * fit.system.own[k];
  }
  information.bottomRightCorner(shared, shared) = fit.system.shared;  // its prior is in it
  rim.tail(shared) = equations.shared_prior();
  information.diagonal() += given;
  all.contour = sandwich(information, all.meat);
  all.given = sandwich(information, given.asDiagonal());
  all.rim = sandwich(information, rim.asDiagonal());
  // As if what is shared, poses following it, were told by one point with this error.
  const double systematic_px = std::max(kSharedError_px, kSystematic * fit.sigma_px);
  const Eigen::MatrixXd inverse = sandwich(information, information), by_shared = inverse.rightCols(shared);
  all.contour += systematic_px * systematic_px * fit.per_px * rows.weight.sum() * by_shared *
                 Eigen::MatrixXd(by_shared.bottomRows(shared)).ldlt().solve(Eigen::MatrixXd(by_shared.transpose()));
  return all;
}

// Of the given pose: what the contour's slope there says, linear from the registered pose, against how much it would say by chance.
double chi_square_of_given(const JointFit& fit, const PosedCovariance& covariance, std::size_t v, const PoseStep& from_given) {
  const auto at = 6 * static_cast<Eigen::Index>(v);
  const Eigen::Index shared = fit.system.shared.rows();
  const PoseStep score = fit.system.score[v] + fit.system.own[v] * from_given;
  PoseCovariance chance = covariance.meat.block<6, 6>(at, at);
  chance += fit.system.mixed[v] * covariance.sum().bottomRightCorner(shared, shared) * fit.system.mixed[v].transpose();
  const PoseStep unit = chance.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  PoseCovariance scaled = unit.asDiagonal() * chance * unit.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const PoseStep s = unit.cwiseProduct(score);
  return s.dot(scaled.ldlt().solve(s));
}

double chance_of_chi_square_6(double x) { return std::exp(-0.5 * x) * (1.0 + 0.5 * x + 0.125 * x * x); }

// Holm's step-down: the chance that any correct pose is contradicted stays at the level.
void contradict(std::vector<RegisteredPosedView>& views, double level) {
  std::vector<std::size_t> order;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (views[v].measured && views[v].problem.empty()) order.push_back(v);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return views[a].chi_square > views[b].chi_square; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (!(chance_of_chi_square_6(views[order[k]].chi_square) <= level / static_cast<double>(order.size() - k))) return;
    views[order[k]].contradicted = true;
  }
}

RegisteredPosedView judged_view(const PosedViewEquations& equations, const JointFit& fit, const PosedCovariance& covariance,
                                const SilhouetteEquations& at_given, std::size_t v, const PosedViewsOptions& options) {
  RegisteredPosedView view;
  view.camera_from_mesh = fit.state.poses[v].camera_from_mesh();
  view.explained = explained_share(fit.silhouettes[v], fit.scale_px);
  view.measured = fit.silhouettes[v].rows.size() >= kLeastRows && view.explained > kLeastExplained;
  if (!view.measured) {
    view.problem = fit.silhouettes[v].rows.empty() ? "no contour" : "most of the mesh's outline lies on no contour";
    return view;
  }
  const auto at = 6 * static_cast<Eigen::Index>(v);
  view.covariance = covariance.sum().block<6, 6>(at, at);
  view.sigma_deg = std::sqrt(view.covariance.topLeftCorner<3, 3>().trace()) * kDegPerRad;
  const double variance = view.covariance.bottomRightCorner<3, 3>().trace();
  view.sigma_m = std::sqrt(variance);
  const auto share = [&](const Eigen::MatrixXd& part) { return part.block<3, 3>(at + 3, at + 3).trace() / variance; };
  view.contour_share = share(covariance.contour);
  view.given_share = share(covariance.given);
  view.rim_share = share(covariance.rim);
  view.given_px = median_distance_px(at_given.rows);
  view.silhouette_px = median_distance_px(fit.silhouettes[v].rows);
  view.chi_square = chi_square_of_given(fit, covariance, v, equations.from_given(fit.state)[v]);
  double length = 0.0;
  for (const SilhouetteEquation& row : fit.silhouettes[v].rows) length += row.length_px * robust_weight(row.distance_px, fit.scale_px);
  const PoseCovariance per_length = fit.system.own[v] / (fit.per_px * length);
  if (!undetermined_turns(per_length, fit.state.poses[v].rotation, equations.mesh().extent().radius_m, equations.px_per_m(v),
                          options.least_turn_share)
           .empty()) {
    view.problem = "the silhouette does not determine the turn about an axis of the mesh";
  }
  return view;
}

PosedViewsRegistration nothing_seen(std::size_t views) {
  PosedViewsRegistration result;
  result.problem = "no contours within reach of the mesh's outline";
  result.views.resize(views);
  for (RegisteredPosedView& view : result.views) view.problem = result.problem;
  return result;
}

PosedViewsRegistration judged(const PosedViewEquations& equations, const JointFit& fit, const PosedViewsOptions& options) {
  const std::size_t views = fit.state.poses.size();
  if (fit.rows < kLeastRows) return nothing_seen(views);
  const PosedCovariance covariance = covariance_of(equations, fit);
  PosedViewsState given = equations.given();
  given.rim_offset_px = fit.state.rim_offset_px;
  const auto at_given = equations.silhouettes(given, 4.0 * kStartScale_px, fit.spacing_px, fit.rim);
  PosedViewsRegistration result;
  for (std::size_t v = 0; v < views; ++v) {
    result.views.push_back(judged_view(equations, fit, covariance, at_given[v], v, options));
  }
  contradict(result.views, options.level);
  result.converged = fit.converged;
  if (!fit.converged) result.problem = "no convergence";
  result.spread = fit.upper;
  result.rim = fit.rim;
  result.independent = covariance.independent;
  result.rim_offset_px = fit.state.rim_offset_px;
  const Eigen::Index shared = 6 * static_cast<Eigen::Index>(views);
  const Eigen::MatrixXd sum = covariance.sum();
  result.rim_offset_sigma_px = std::sqrt(sum(shared, shared));
  if (equations.shared_unknowns() == 1) return result;
  result.lens_step = fit.state.lens;
  result.lens_covariance = sum.block<3, 3>(shared + 1, shared + 1);
  const Eigen::Vector3d unit = result.lens_covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Vector3d step = unit.cwiseProduct(fit.state.lens);
  result.lens_chi_square =
      step.dot(Eigen::Matrix3d(unit.asDiagonal() * result.lens_covariance * unit.asDiagonal()).ldlt().solve(step));
  return result;
}

bool same_camera(const CameraModel& a, const CameraModel& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.focal_x_px == b.focal_x_px && a.focal_y_px == b.focal_y_px &&
         a.principal_x_px == b.principal_x_px && a.principal_y_px == b.principal_y_px && a.k1 == b.k1 && a.k2 == b.k2 &&
         a.p1 == b.p1 && a.p2 == b.p2;
}

void check(const MeshSilhouette& mesh, const std::vector<PosedView>& views) {
  if (views.empty()) throw BadInput("poses", "no views", "at least one");
  for (const PosedView& view : views) {
    if (!view.camera_from_mesh.matrix().allFinite() || !((view.camera_from_mesh * mesh.extent().centre).z() > 0.0))
      throw BadInput("pose", "not finite, or with the object behind the camera", "the object in front of it");
  }
}

}  // namespace

PosedViewsRegistration register_posed_views(const MeshSilhouette& mesh, const std::vector<PosedView>& views,
                                            const PosedViewsOptions& options) {
  check(mesh, views);
  const PosedViewEquations poses(mesh, views, false, options.rim_offset_sigma_px);
  JointFit fit = fit_views(poses, options);
  PosedViewsRegistration result = judged(poses, fit, options);
  const bool one_camera = std::all_of(views.begin(), views.end(),
                                      [&](const PosedView& view) { return same_camera(view.camera, views[0].camera); });
  if (!options.refine_lens || !one_camera || !result.converged) return result;
  const PosedViewEquations poses_and_lens(mesh, views, true, options.rim_offset_sigma_px);
  PosedViewsRegistration with_lens = judged(poses_and_lens, refine(poses_and_lens, fit), options);
  // Chance of a chi-square of three degrees of freedom.
  const double x = with_lens.lens_chi_square;
  const double chance = std::erfc(std::sqrt(0.5 * x)) + std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-0.5 * x);
  if (with_lens.converged && chance <= options.level) {
    with_lens.lens_contradicted = true;
    return with_lens;
  }
  result.lens_step = with_lens.lens_step;
  result.lens_covariance = with_lens.lens_covariance;
  result.lens_chi_square = with_lens.lens_chi_square;
  return result;
}

}  // namespace lumitexel
