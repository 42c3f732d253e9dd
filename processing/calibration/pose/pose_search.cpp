#include "processing/calibration/pose/pose_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kTurnSpacing_deg = 12.0;     // well within the refinement's reach
constexpr std::size_t kRefined = 14;          // candidates of the search that are refined
constexpr std::size_t kRefinedOfAll = 40;     // likewise when any rotation is possible
constexpr double kSamePose_deg = 3.0;
constexpr int kOutlinePoints = 160;

// A step in units in which turns and shifts both count as pixels of a point at the object's radius.
PoseStep units_of(const ViewToRegister& view, const CentredPose& pose) {
  const double m_per_px = std::max(pose.centre_in_camera.z(), 1e-9) / focal_px(view.camera);
  PoseStep units;
  units << Eigen::Vector3d::Constant(m_per_px / view.mesh.extent().radius_m), Eigen::Vector3d::Constant(m_per_px);
  return units;
}

// The step in those units. A trace of damping stops what the contour does not determine.
PoseStep solve_step(const std::vector<SilhouetteEquation>& rows, double scale_px, const PoseStep& units) {
  PoseCovariance information = PoseCovariance::Zero();
  PoseStep gradient = PoseStep::Zero();
  for (const SilhouetteEquation& row : rows) {
    const PoseStep j = row.by_pose.transpose().cwiseProduct(units);
    const double w = row.length_px * robust_weight(row.distance_px, scale_px);
    information += w * j * j.transpose();
    gradient += w * row.distance_px * j;
  }
  information.diagonal().array() += 1e-6 * information.trace() + 1e-300;
  return information.ldlt().solve(gradient);
}

std::vector<Eigen::Matrix3d> turns_within(double limit_deg) {
  std::vector<Eigen::Matrix3d> turns{Eigen::Matrix3d::Identity()};
  if (limit_deg < 90.0) {
    const int reach = static_cast<int>(limit_deg / kTurnSpacing_deg);
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) {
        for (int z = -reach; z <= reach; ++z) {
          const Eigen::Vector3d turn_deg = kTurnSpacing_deg * Eigen::Vector3d(x, y, z);
          if (turn_deg.norm() > limit_deg || turn_deg.isZero()) continue;
          turns.push_back(rotation_by(turn_deg * std::numbers::pi / 180.0));
        }
      }
    }
    return turns;
  }
  // Evenly over all rotations: Alexa's spiral on the sphere of quaternions ("Super-Fibonacci spirals", 2022).
  constexpr int kTurns = 600;
  constexpr double kPhi = std::numbers::sqrt2, kPsi = 1.533751168755204288118041;
  for (int i = 0; i < kTurns; ++i) {
    const double s = i + 0.5, r = std::sqrt(s / kTurns), q = std::sqrt(1.0 - s / kTurns);
    const double a = 2.0 * std::numbers::pi * s / kPhi, b = 2.0 * std::numbers::pi * s / kPsi;
    turns.push_back(Eigen::Quaterniond(q * std::cos(b), r * std::sin(a), r * std::cos(a), q * std::sin(b)).toRotationMatrix());
  }
  return turns;
}

struct Placed {
  CentredPose pose;
  double cost = 0;
};

// The outline in pixels from the object's middle, with the eighth of directions that each point faces.
struct OutlinePoint {
  Eigen::Vector2d from_middle;
  std::size_t direction;
  double share;  // of the outline's length
};

std::vector<OutlinePoint> outline_about(const ViewToRegister& view, const CentredPose& pose, const Eigen::Vector2d& middle,
                                        double spacing_px, RimModel model) {
  std::vector<OutlinePoint> points;
  double length_px = 0.0;
  // Short pieces, one a facet, are thinned: only every spacing_px of length counts.
  double due_px = 0.0;
  for (const RimPoint& rim : view.mesh.outline(view.camera, pose, spacing_px, model)) {
    length_px += rim.length_px;
    due_px += rim.length_px;
    if (due_px < spacing_px) continue;
    points.push_back({rim.pixel - middle, view.contour.direction_of(rim.normal), due_px});
    due_px = 0.0;
  }
  for (OutlinePoint& point : points) point.share /= length_px;
  return points;
}

// The mean distance, cut off, of an outline moved and scaled; given up once it passes `best`.
double placed_cost(const ViewToRegister& view, const std::vector<OutlinePoint>& outline, const Eigen::Vector2d& middle,
                   double scale, double cut_px, double best) {
  double cost = 0.0;
  for (const OutlinePoint& point : outline) {
    const double distance = view.contour.distance_px(middle + scale * point.from_middle, point.direction);
    cost += point.share * std::min(distance / cut_px, 1.0);
    if (cost >= best) return best;
  }
  return cost;
}

// The best of a grid of shifts and distances, all with one outline, scaled: a turn is seen a little from elsewhere then.
Placed best_shift(const ViewToRegister& view, const CentredPose& pose, double shift_m, RimModel model) {
  const double size_px = diameter_px(view, pose), step_px = size_px / 20.0;
  const Eigen::Vector2d middle = view.camera.project(pose.centre_in_camera);
  const std::vector<OutlinePoint> outline = outline_about(view, pose, middle, size_px * 3.0 / kOutlinePoints, model);
  Placed best{pose, 1e300};
  if (outline.empty()) return best;
  const double z = pose.centre_in_camera.z(), focal = size_px * z / (2.0 * view.mesh.extent().radius_m);
  const int depths = static_cast<int>(std::ceil(shift_m / z * 0.5 * size_px / step_px));
  const int reach = static_cast<int>(std::ceil(shift_m * focal / z / step_px));
  for (int d = -depths; d <= depths; ++d) {
    const double depth = z + (depths > 0 ? shift_m * d / depths : 0.0);
    if (depth < 0.2 * z) continue;
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Eigen::Vector2d shift = step_px * Eigen::Vector2d(x, y);
        const double cost = placed_cost(view, outline, middle + shift, z / depth, 1.5 * step_px, best.cost);
        if (cost >= best.cost) continue;
        best.cost = cost;
        best.pose.centre_in_camera = pose.centre_in_camera;
        best.pose.centre_in_camera.head<2>() += shift * z / focal;
        best.pose.centre_in_camera *= depth / z;
      }
    }
  }
  return best;
}

}  // namespace

double focal_px(const CameraModel& camera) { return 0.5 * (camera.focal_x_px + camera.focal_y_px); }

double diameter_px(const ViewToRegister& view, const CentredPose& pose) {
  return 2.0 * view.mesh.extent().radius_m * focal_px(view.camera) / std::max(pose.centre_in_camera.z(), 1e-9);
}

double explained_share(const SilhouetteEquations& equations, double scale_px) {
  double sum = 0.0;
  for (const SilhouetteEquation& row : equations.rows) {
    sum += row.length_px * std::sqrt(robust_weight(row.distance_px, scale_px));
  }
  return equations.outline_px > 0.0 ? sum / equations.outline_px : 0.0;
}

double settled_px(double scale_px) { return 0.002 + 0.01 * scale_px; }

PoseFit refine_pose(const ViewToRegister& view, const CentredPose& start, const RefineOptions& options) {
  PoseFit fit;
  fit.pose = start;
  const double most_px = 0.15 * diameter_px(view, start);  // a step's bound: beyond it nothing is linear
  double scale_px = options.start_scale_px;
  for (fit.iterations = 0; fit.iterations <= options.max_iterations; ++fit.iterations) {
    fit.equations = silhouette_equations(view.mesh, view.contour, view.camera, fit.pose, 4.0 * scale_px,
                                         options.spacing_px, options.model);
    const double own_px = std::max(3.0 * robust_sigma_px(fit.equations.rows), kLeastScale_px);
    const bool shrunk = scale_px <= own_px * 1.001;
    fit.scale_px = shrunk ? own_px : std::max(own_px, 0.6 * scale_px);
    if (!shrunk) scale_px = fit.scale_px;
    fit.explained = explained_share(fit.equations, fit.scale_px);
    if (fit.converged && shrunk) break;
    if (fit.equations.rows.size() < 12 || fit.iterations == options.max_iterations) break;
    const PoseStep units = units_of(view, fit.pose);
    PoseStep step = solve_step(fit.equations.rows, fit.scale_px, units);
    const double length_px = step.norm();
    if (!std::isfinite(length_px)) break;
    if (length_px > most_px) step *= most_px / length_px;
    fit.pose = fit.pose.moved(step.cwiseProduct(units));
    fit.converged = shrunk && length_px < settled_px(fit.scale_px);
    if (!(fit.pose.centre_in_camera.z() > 0.0)) break;
  }
  return fit;
}

std::vector<PoseFit> search_pose(const ViewToRegister& view, const CentredPose& start, const SearchRange& range,
                                 RimModel model) {
  std::vector<Placed> placed;
  for (const Eigen::Matrix3d& turn : turns_within(range.turn_deg)) {
    CentredPose turned = start;
    turned.rotation = turn * start.rotation;
    const Placed found = best_shift(view, turned, range.shift_m, model);
    if (found.cost <= 1.0) placed.push_back(found);
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.cost < b.cost; });
  placed.resize(std::min(placed.size(), range.turn_deg < 90.0 ? kRefined : kRefinedOfAll));
  std::vector<PoseFit> fits;
  for (const Placed& candidate : placed) {
    const double size_px = diameter_px(view, candidate.pose);
    const RefineOptions coarse{size_px / 20.0, std::max(2.0, size_px * 3.0 / (2 * kOutlinePoints)), 20, model};
    fits.push_back(refine_pose(view, candidate.pose, coarse));
  }
  // Explained at one scale for all: each one's own would reward a loose fit.
  double scale_px = 1e300;
  for (const PoseFit& fit : fits) {
    if (fit.equations.matched_px > 0.5 * fit.equations.outline_px) scale_px = std::min(scale_px, fit.scale_px);
  }
  for (PoseFit& fit : fits) fit.explained = explained_share(fit.equations, std::max(2.0 * scale_px, 1.5));
  std::stable_sort(fits.begin(), fits.end(), [](const PoseFit& a, const PoseFit& b) { return a.explained > b.explained; });
  std::vector<PoseFit> distinct;
  for (const PoseFit& fit : fits) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const PoseFit& other) {
      return Eigen::AngleAxisd(fit.pose.rotation * other.pose.rotation.transpose()).angle() * 180.0 / std::numbers::pi < kSamePose_deg;
    });
    if (!known) distinct.push_back(fit);
  }
  return distinct;
}

}  // namespace lumitexel
