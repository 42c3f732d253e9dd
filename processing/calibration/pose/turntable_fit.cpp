#include "processing/calibration/pose/turntable_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "processing/calibration/pose/pose_search.h"

namespace lumitexel {
namespace {

// Solved with every unknown at unit information, and a trace of damping for what nothing determines.
Eigen::VectorXd solve_damped(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient) {
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd unit = scale.asDiagonal() * information * scale.asDiagonal();
  unit.diagonal().array() += 1e-9;
  return scale.cwiseProduct(unit.ldlt().solve(scale.cwiseProduct(gradient)));
}

}  // namespace

std::vector<SilhouetteEquation> all_rows(const std::vector<SilhouetteEquations>& silhouettes) {
  std::vector<SilhouetteEquation> rows;
  for (const SilhouetteEquations& one : silhouettes) rows.insert(rows.end(), one.rows.begin(), one.rows.end());
  return rows;
}

double explained_by(const std::vector<SilhouetteEquations>& silhouettes, double scale_px) {
  double sum = 0.0, length = 0.0;
  for (const SilhouetteEquations& one : silhouettes) {
    sum += explained_share(one, scale_px) * one.outline_px;
    length += one.outline_px;
  }
  return length > 0.0 ? sum / length : 0.0;
}

TurntableFit fit_turntable(const TurntableProblem& problem, const TurntableModel& start, double px_per_m,
                           const TurntableFitOptions& options) {
  TurntableFit fit;
  fit.model = start;
  double scale_px = options.start_scale_px, last_px = 1e300;
  const double radius_px = 0.15 * options.start_scale_px * 20.0;
  for (int iteration = 0; iteration <= options.max_iterations; ++iteration) {
    fit.silhouettes = problem.silhouettes(fit.model, 4.0 * scale_px, options.spacing_px, options.rim);
    const std::vector<SilhouetteEquation> rows = all_rows(fit.silhouettes);
    fit.sigma_px = robust_sigma_px(rows);
    const double own_px = std::max(3.0 * fit.sigma_px, kLeastScale_px);
    const bool shrunk = scale_px <= own_px * 1.001;
    fit.weights.scale_px = shrunk ? own_px : std::max(own_px, 0.6 * scale_px);
    if (!shrunk) scale_px = fit.weights.scale_px;
    fit.explained = explained_by(fit.silhouettes, fit.weights.scale_px);
    const double sigma_px = std::max(fit.sigma_px, 0.02);
    fit.weights.per_px = 1.0 / (sigma_px * sigma_px * options.correlation);
    fit.weights.swell_sigma_m = sigma_px / px_per_m;
    fit.converged = shrunk && last_px < settled_px(fit.weights.scale_px);
    if (fit.converged || iteration == options.max_iterations || rows.size() < kLeastRows) break;
    fit.weights.tag_floor_px = shrunk ? 0.0 : fit.weights.scale_px;
    const TurntableInformation all = problem.information(fit.model, fit.silhouettes, fit.weights);
    Eigen::VectorXd step = solve_damped(all.sum(), all.gradient);
    if (!step.allFinite()) break;
    // Of the first view, in pixels of a point at the object's size.
    const double turn_px = step.head<3>().norm() * fit.model.camera_from_mesh.centre_in_camera.z();
    last_px = px_per_m * std::max(step.segment<3>(3).norm(), std::min(turn_px, 1e9) * 0.05);
    if (last_px > std::max(radius_px, 50.0)) step *= std::max(radius_px, 50.0) / last_px;
    const TurntableModel next = moved(fit.model, problem.unknowns, step);
    if (!(next.camera_from_mesh.centre_in_camera.z() > 0.0)) break;
    fit.model = next;
  }
  return fit;
}

}  // namespace lumitexel
