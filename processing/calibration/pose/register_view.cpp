#include "processing/calibration/pose/register_view.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/error.h"
#include "processing/calibration/pose/residual_correlation.h"

namespace lumitexel {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kCorrelationReach = 0.4;  // of the mesh's radius: contour errors farther apart have nothing in common
constexpr double kClearlyBetter = 0.9;     // facets instead of a smooth surface
constexpr double kLeastExplained = 0.5;    // below, most of the outline lies on nothing
constexpr double kEquallyGood = 1.25;      // ratio of two fits' robust distances that noise and facets may make

double spacing_px(const ViewToRegister& view, const CentredPose& pose, std::size_t points, RimModel model) {
  double length_px = 0.0;
  const double coarse_px = std::max(1.0, 0.02 * view.mesh.extent().radius_m * focal_px(view.camera) / pose.centre_in_camera.z());
  for (const RimPoint& rim : view.mesh.outline(view.camera, pose, coarse_px, model)) length_px += rim.length_px;
  return std::max(1.0, length_px / static_cast<double>(points));
}

PoseFit refined(const ViewToRegister& view, const CentredPose& start, double start_scale_px, std::size_t points, RimModel model) {
  return refine_pose(view, start, {start_scale_px, spacing_px(view, start, points, model), 40, model});
}

bool as_good(const PoseFit& other, const PoseFit& best) {
  return median_distance_px(other.equations.rows) < kEquallyGood * median_distance_px(best.equations.rows) + 0.02 &&
         other.explained > 0.9 * best.explained && other.equations.matched_px > 0.9 * best.equations.matched_px;
}

bool better(const PoseFit& a, const PoseFit& b) {
  // Explained at the wider scale, so that a tight fit of a small part does not win.
  const double scale = std::max(a.scale_px, b.scale_px);
  const auto share = [&](const PoseFit& fit) {
    double sum = 0.0;
    for (const SilhouetteEquation& row : fit.equations.rows) sum += row.length_px * robust_weight(row.distance_px, scale);
    return fit.equations.outline_px > 0.0 ? sum / fit.equations.outline_px : 0.0;
  };
  return share(a) > share(b);
}

// The best first; the others that were refined follow.
std::vector<PoseFit> fits_near(const ViewToRegister& view, const CentredPose& start, const ViewRegistrationOptions& options,
                               RimModel model) {
  std::vector<PoseFit> fits;
  if (options.search.turn_deg <= 0.0 && options.search.shift_m <= 0.0) {
    fits.push_back(refined(view, start, 10.0, options.rim_points, model));
    return fits;
  }
  constexpr std::size_t kRefined = 3;
  for (const PoseFit& coarse : search_pose(view, start, options.search, model)) {
    fits.push_back(refined(view, coarse.pose, std::max(3.0, coarse.scale_px), options.rim_points, model));
    if (fits.size() == kRefined) break;
  }
  std::stable_sort(fits.begin(), fits.end(), better);
  return fits;
}

PoseAmbiguity turn_between(const CentredPose& from, const CentredPose& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(from.rotation.transpose() * to.rotation));
  return {turn.axis(), turn.angle() * kDegPerRad};
}

void add_other_poses(const ViewToRegister& view, const PoseFit& best, const std::vector<PoseFit>& others,
                     const ViewRegistrationOptions& options, ViewRegistration& result) {
  std::vector<PoseFit> candidates = others;
  if (options.other_rotations) {
    const double around_m = 0.25 * view.mesh.extent().radius_m;
    for (const PoseFit& coarse : search_pose(view, best.pose, {180.0, around_m}, result.model)) {
      if (coarse.explained < 0.7 * best.explained) continue;
      candidates.push_back(refined(view, coarse.pose, std::max(3.0, coarse.scale_px), options.rim_points / 2, result.model));
    }
  }
  constexpr double kElsewhere_deg = 2.0;
  for (const PoseFit& other : candidates) {
    const PoseAmbiguity turn = turn_between(best.pose, other.pose);
    if (turn.angle_deg < std::max(kElsewhere_deg, 5.0 * result.sigma_deg) || !as_good(other, best)) continue;
    const bool known = std::any_of(result.ambiguities.begin(), result.ambiguities.end(), [&](const PoseAmbiguity& a) {
      const double aligned = std::abs(a.axis_in_mesh.dot(turn.axis_in_mesh));
      return aligned > 0.98 && (a.angle_deg == 0.0 || std::abs(a.angle_deg - turn.angle_deg) < kElsewhere_deg);
    });
    if (!known) result.ambiguities.push_back(turn);
  }
}

void add_covariance(const ViewToRegister& view, const PoseFit& fit, const ViewRegistrationOptions& options, ViewRegistration& result) {
  const auto& rows = fit.equations.rows;
  const auto count = static_cast<Eigen::Index>(rows.size());
  WeightedResiduals weighted{{}, Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::MatrixXd(count, 6)};
  PoseCovariance per_length = PoseCovariance::Zero();
  PoseStep by_swell = PoseStep::Zero();
  double length = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const SilhouetteEquation& row = rows[static_cast<std::size_t>(i)];
    weighted.x_in_mesh.push_back(row.x_in_mesh);
    weighted.residual[i] = row.distance_px;
    weighted.weight[i] = row.length_px * robust_weight(row.distance_px, fit.scale_px);
    weighted.jacobian.row(i) = row.by_pose;
    per_length += weighted.weight[i] * row.by_pose.transpose() * row.by_pose;
    by_swell += weighted.weight[i] * row.by_swell * row.by_pose.transpose();
    length += weighted.weight[i];
  }
  const FitCovariance scores = correlated_scores(weighted, kCorrelationReach * view.mesh.extent().radius_m);
  // A mesh whose contour scatters by so much may well be too thin or too thick by as much all around, which a single
  // view takes for distance: not estimated, but its share is in the covariance.
  const double px_per_m = focal_px(view.camera) / fit.pose.centre_in_camera.z();
  const double swell_m = robust_sigma_px(rows) / px_per_m;
  const PoseCovariance meat = scores.meat + swell_m * swell_m * by_swell * by_swell.transpose() +
                              kSharedError_px * kSharedError_px * length * per_length;
  result.covariance = sandwich(per_length, meat);
  result.independent = scores.independent;
  result.sigma_deg = std::sqrt(result.covariance.topLeftCorner<3, 3>().trace()) * kDegPerRad;
  result.sigma_m = std::sqrt(result.covariance.bottomRightCorner<3, 3>().trace());
  result.ambiguities = undetermined_turns(per_length / length, fit.pose.rotation, view.mesh.extent().radius_m,
                                          px_per_m, options.least_turn_share);
}

}  // namespace

std::vector<PoseAmbiguity> undetermined_turns(const PoseCovariance& information, const Eigen::Matrix3d& camera_from_mesh,
                                              double radius_m, double px_per_m, double least_turn_share) {
  const Eigen::Matrix3d turns = information.topLeftCorner<3, 3>(), mixed = information.topRightCorner<3, 3>(),
                        shifts = information.bottomRightCorner<3, 3>();
  const double small = 1e-12 * shifts.trace();
  const Eigen::Matrix3d kept = shifts + small * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d alone = turns - mixed * kept.ldlt().solve(Eigen::Matrix3d(mixed.transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(alone);
  std::vector<PoseAmbiguity> result;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double share = std::sqrt(std::max(eigen.eigenvalues()[k], 0.0)) / (radius_m * px_per_m);
    if (share < least_turn_share) result.push_back({camera_from_mesh.transpose() * eigen.eigenvectors().col(k), 0.0});
  }
  return result;
}

ViewRegistration register_view(const MeshSilhouette& mesh, const ContourLookup& contour, const CameraModel& camera,
                               const Eigen::Isometry3d& camera_from_mesh_start, const ViewRegistrationOptions& options) {
  const CentredPose start(camera_from_mesh_start, mesh.extent().centre);
  if (!camera_from_mesh_start.matrix().allFinite() || !(start.centre_in_camera.z() > 0.0))
    throw BadInput("pose", "a start that is not finite or has the object behind the camera", "the object in front of it");
  const ViewToRegister view{mesh, contour, camera};
  ViewRegistration result;
  result.centre_in_mesh = mesh.extent().centre;
  result.model = options.model.value_or(RimModel::Smooth);
  std::vector<PoseFit> fits = fits_near(view, start, options, result.model);
  if (fits.empty() || fits[0].equations.rows.size() < 12) {
    result.problem = "no contour within reach of the mesh's outline";
    return result;
  }
  if (!options.model) {
    const PoseFit facets = refined(view, fits[0].pose, 3.0, options.rim_points, RimModel::Facets);
    if (median_distance_px(facets.equations.rows) < kClearlyBetter * median_distance_px(fits[0].equations.rows) &&
        facets.explained >= 0.98 * fits[0].explained) {
      fits[0] = facets;
      result.model = RimModel::Facets;
    }
  }
  const PoseFit& best = fits[0];
  result.camera_from_mesh = best.pose.camera_from_mesh();
  result.silhouette_px = median_distance_px(best.equations.rows);
  result.explained = best.explained;
  add_covariance(view, best, options, result);
  result.converged = best.converged && best.explained > kLeastExplained;
  if (best.explained <= kLeastExplained) {
    result.problem = "most of the mesh's outline lies on no contour";
    return result;
  }
  add_other_poses(view, best, {fits.begin() + 1, fits.end()}, options, result);
  if (result.ambiguous()) result.problem = "the silhouette does not determine the turn about an axis of the mesh";
  else if (!best.converged) result.problem = "no convergence";
  return result;
}

}  // namespace lumitexel
