#include "processing/calibration/pose/register_turntable.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/error.h"
#include "processing/calibration/pose/residual_correlation.h"

namespace lumitexel {
namespace {

using U = TurntableUnknowns;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kCorrelationReach = 0.4;  // as in register_view.cpp
constexpr double kLeastExplained = 0.5;
constexpr double kTagScale = 4.0;  // standard deviations; a misread corner is farther off
constexpr double kClearlyBetter = 0.9;  // facets instead of a smooth surface
constexpr std::size_t kLeastRows = 20;

struct TagCorner {
  std::size_t view;
  Eigen::Vector3d x_in_table;
  Eigen::Vector2d pixel;
  double sigma_px;
};

// What each source says about the unknowns.
struct Information {
  Eigen::MatrixXd contour, tags, lens, angles, mesh;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd sum() const { return contour + tags + lens + angles + mesh; }
};

// Terms that a lens does not have are known to be zero: they come with no variance.
Eigen::Matrix<double, 8, 8> information_of_lens(Eigen::Matrix<double, 8, 8> covariance) {
  constexpr double kExact = 1e-24;
  covariance.diagonal() = covariance.diagonal().cwiseMax(kExact);
  const LensVector scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, 8, 8> unit = scale.asDiagonal() * covariance * scale.asDiagonal();
  return scale.asDiagonal() * unit.ldlt().solve(Eigen::Matrix<double, 8, 8>::Identity()) * scale.asDiagonal();
}

class TurntableProblem {
 public:
  TurntableProblem(const MeshSilhouette& mesh, const std::vector<TurntableView>& views, const TurntableStart& start,
                   std::vector<TagCorner> corners, const TurntableOptions& options)
      : unknowns(!corners.empty(), options.lens_covariance.has_value(), options.angle_sigma_deg > 0.0, views.size()),
        mesh_(mesh), views_(views), corners_(std::move(corners)), options_(options), first_camera_(start.camera) {
    if (options.lens_covariance) lens_information_ = information_of_lens(*options.lens_covariance);
  }

  const TurntableUnknowns unknowns;

  double angle_rad(const TurntableModel& model, std::size_t view) const {
    return views_[view].angle_deg * kRadPerDeg + model.angle_offset_rad[view];
  }
  CentredPose pose(const TurntableModel& model, std::size_t view) const { return pose_at(model, angle_rad(model, view)); }

  std::vector<SilhouetteEquations> silhouettes(const TurntableModel& model, double reach_px, double spacing_px,
                                               RimModel rim) const {
    std::vector<SilhouetteEquations> all(views_.size());
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (views_[v].contour == nullptr) continue;
      all[v] = silhouette_equations(mesh_, *views_[v].contour, model.camera, pose(model, v), reach_px, spacing_px, rim);
      for (SilhouetteEquation& row : all[v].rows) row.distance_px -= model.swell_m * row.by_swell;
    }
    return all;
  }

  // per_px: weight of a pixel of contour, in 1/px^2. swell_sigma_m: how far the surface may be off the mesh all around.
  Information information(const TurntableModel& model, const std::vector<SilhouetteEquations>& silhouettes, double scale_px,
                          double per_px, double swell_sigma_m) const {
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(unknowns.count, unknowns.count);
    Information all{none, none, none, none, none, Eigen::VectorXd::Zero(unknowns.count)};
    for (std::size_t v = 0; v < views_.size(); ++v) {
      Eigen::Matrix<double, 15, 15> local = Eigen::Matrix<double, 15, 15>::Zero();
      Eigen::Matrix<double, 15, 1> right = Eigen::Matrix<double, 15, 1>::Zero();
      for (const SilhouetteEquation& row : silhouettes[v].rows) {
        const Eigen::Matrix<double, 15, 1> j = local_row(row);
        const double w = per_px * row.length_px * robust_weight(row.distance_px, scale_px);
        local += w * j * j.transpose();
        right += w * row.distance_px * j;
      }
      const Eigen::MatrixXd d = view_derivatives(model, unknowns, v, angle_rad(model, v));
      all.contour += d.transpose() * local * d;
      all.gradient += d.transpose() * right;
    }
    for (const TagCorner& corner : corners_) add_corner(model, corner, all);
    add_priors(model, swell_sigma_m, all);
    return all;
  }

  // Weighted rows over all unknowns, for their correlation.
  WeightedResiduals weighted_rows(const TurntableModel& model, const std::vector<SilhouetteEquations>& silhouettes,
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

  double tag_rms_px(const TurntableModel& model, std::size_t view) const {
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

 private:
  static Eigen::Matrix<double, 15, 1> local_row(const SilhouetteEquation& row) {
    Eigen::Matrix<double, 15, 1> j;
    j << row.by_pose.transpose(), row.by_swell, row.by_lens.transpose();
    return j;
  }

  void add_corner(const TurntableModel& model, const TagCorner& corner, Information& all) const {
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
    const double w = robust_weight(off.norm(), kTagScale * std::max(corner.sigma_px, tag_floor_px_)) / (corner.sigma_px * corner.sigma_px);
    all.tags += w * j.transpose() * j;
    all.gradient += w * j.transpose() * off;
  }

  void add_priors(const TurntableModel& model, double swell_sigma_m, Information& all) const {
    const double swell = 1.0 / (swell_sigma_m * swell_sigma_m);
    all.mesh(U::kSwell, U::kSwell) = swell;
    all.gradient[U::kSwell] -= swell * model.swell_m;
    if (unknowns.lens >= 0) {
      const CameraModel &c = model.camera, &f = first_camera_;
      LensVector off;
      off << c.focal_x_px - f.focal_x_px, c.focal_y_px - f.focal_y_px, c.principal_x_px - f.principal_x_px,
          c.principal_y_px - f.principal_y_px, c.k1 - f.k1, c.k2 - f.k2, c.p1 - f.p1, c.p2 - f.p2;
      all.lens.block<8, 8>(unknowns.lens, unknowns.lens) = lens_information_;
      all.gradient.segment<8>(unknowns.lens) -= lens_information_ * off;
    }
    if (unknowns.angles < 0) return;
    const double angle = 1.0 / std::pow(options_.angle_sigma_deg * kRadPerDeg, 2);
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const Eigen::Index k = unknowns.angles + static_cast<Eigen::Index>(v);
      all.angles(k, k) = angle;
      all.gradient[k] -= angle * model.angle_offset_rad[v];
    }
  }

  const MeshSilhouette& mesh_;
  const std::vector<TurntableView>& views_;
  std::vector<TagCorner> corners_;
  const TurntableOptions& options_;
  CameraModel first_camera_;
  Eigen::Matrix<double, 8, 8> lens_information_ = Eigen::Matrix<double, 8, 8>::Zero();

 public:
  double tag_floor_px_ = 0.0;  // far from the solution corners may be off by this; shrinks with the contours' scale
};

struct JointFit {
  TurntableModel model;
  std::vector<SilhouetteEquations> silhouettes;
  double scale_px = 0, sigma_px = 0, swell_sigma_m = 1, per_px = 1, explained = 0;
  bool converged = false;
};

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

// Solved with every unknown at unit information, and a trace of damping for what nothing determines.
Eigen::VectorXd solve_damped(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient) {
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd unit = scale.asDiagonal() * information * scale.asDiagonal();
  unit.diagonal().array() += 1e-9;
  return scale.cwiseProduct(unit.ldlt().solve(scale.cwiseProduct(gradient)));
}

struct JointOptions {
  double start_scale_px, spacing_px;
  RimModel rim;
  double correlation = 1.0;  // as many contour points say as much as one independent one
  int max_iterations = 40;
};

JointFit refine_jointly(TurntableProblem& problem, const TurntableModel& start, double px_per_m, const JointOptions& options) {
  JointFit fit;
  fit.model = start;
  double scale_px = options.start_scale_px, last_px = 1e300;
  const double radius_px = 0.15 * options.start_scale_px * 20.0;
  for (int iteration = 0; iteration <= options.max_iterations; ++iteration) {
    fit.silhouettes = problem.silhouettes(fit.model, 4.0 * scale_px, options.spacing_px, options.rim);
    const std::vector<SilhouetteEquation> rows = all_rows(fit.silhouettes);
    fit.sigma_px = robust_sigma_px(rows);
    const double own_px = std::max(3.0 * fit.sigma_px, kLeastScale_px);
    const bool shrunk = scale_px <= own_px * 1.001;
    fit.scale_px = shrunk ? own_px : std::max(own_px, 0.6 * scale_px);
    if (!shrunk) scale_px = fit.scale_px;
    fit.explained = explained_by(fit.silhouettes, fit.scale_px);
    const double sigma_px = std::max(fit.sigma_px, 0.02);
    fit.per_px = 1.0 / (sigma_px * sigma_px * options.correlation);
    fit.swell_sigma_m = sigma_px / px_per_m;
    fit.converged = shrunk && last_px < settled_px(fit.scale_px);
    if (fit.converged || iteration == options.max_iterations || rows.size() < kLeastRows) break;
    problem.tag_floor_px_ = shrunk ? 0.0 : fit.scale_px;
    const Information all = problem.information(fit.model, fit.silhouettes, fit.scale_px, fit.per_px, fit.swell_sigma_m);
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

TurntableModel first_model(const MeshSilhouette& mesh, const TurntableStart& start, std::size_t views,
                           const Eigen::Isometry3d& table_from_mesh) {
  TurntableModel model;
  const Eigen::Isometry3d mesh_from_table = table_from_mesh.inverse();
  model.camera_from_mesh = CentredPose(start.camera_from_table * table_from_mesh, mesh.extent().centre);
  model.axis_in_mesh = (mesh_from_table.linear() * start.axis_in_table).normalized();
  model.axis_point_in_mesh = mesh_from_table * start.axis_point_in_table;
  // The axis' point nearest to the mesh, so that a tilt does not swing it away.
  const Eigen::Vector3d to_centre = mesh.extent().centre - model.axis_point_in_mesh;
  model.axis_point_in_mesh += to_centre.dot(model.axis_in_mesh) * model.axis_in_mesh;
  model.mesh_from_table = mesh_from_table;
  model.camera = start.camera;
  model.angle_offset_rad.assign(views, 0.0);
  return model;
}

// Where one view's search puts the mesh: moved on the table (the camera stands right), or with the table (the camera does not).
std::vector<TurntableModel> placements(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                       const TurntableStart& start, const TurntableOptions& options) {
  const TurntableModel nominal = first_model(mesh, start, views.size(), start.table_from_mesh);
  std::vector<TurntableModel> models{nominal};
  if (options.search.turn_deg <= 0.0 && options.search.shift_m <= 0.0) return models;
  const std::size_t step = std::max<std::size_t>(1, views.size() / 3);
  for (std::size_t v = 0; v < views.size(); v += step) {
    if (views[v].contour == nullptr) continue;
    const double angle = views[v].angle_deg * kRadPerDeg;
    const Eigen::Isometry3d turned = pose_at(nominal, angle).camera_from_mesh();
    const ViewToRegister view{mesh, *views[v].contour, start.camera};
    const auto found = search_pose(view, CentredPose(turned, mesh.extent().centre), options.search,
                                   options.model.value_or(RimModel::Smooth));
    for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 4); ++k) {
      const Eigen::Isometry3d camera_from_mesh = found[k].pose.camera_from_mesh();
      const Eigen::Isometry3d at_zero = nominal.camera_from_mesh.camera_from_mesh() * turned.inverse() * camera_from_mesh;
      Eigen::Isometry3d turn_of_table = Eigen::Translation3d(start.axis_point_in_table) *
                                        Eigen::AngleAxisd(angle, start.axis_in_table.normalized()) *
                                        Eigen::Translation3d(-start.axis_point_in_table);
      const Eigen::Isometry3d table_from_mesh = (start.camera_from_table * turn_of_table).inverse() * camera_from_mesh;
      models.push_back(first_model(mesh, start, views.size(), table_from_mesh));
      TurntableModel with_camera = nominal;
      with_camera.camera_from_mesh = CentredPose(at_zero, mesh.extent().centre);
      models.push_back(with_camera);
    }
  }
  return models;
}

void fill_views(const TurntableProblem& problem, const JointFit& fit, const Eigen::MatrixXd& bread, const Information& all,
                const Eigen::MatrixXd& contour_meat, TurntableRegistration& result) {
  const Eigen::MatrixXd by_contour = bread * contour_meat * bread, by_tags = bread * all.tags * bread,
                        by_lens = bread * all.lens * bread, by_angles = bread * all.angles * bread,
                        by_mesh = bread * all.mesh * bread;
  result.covariance = by_contour + by_tags + by_lens + by_angles + by_mesh;
  for (std::size_t v = 0; v < fit.silhouettes.size(); ++v) {
    RegisteredView view;
    view.camera_from_mesh = problem.pose(fit.model, v).camera_from_mesh();
    const Eigen::MatrixXd d = view_derivatives(fit.model, problem.unknowns, v, problem.angle_rad(fit.model, v)).topRows(6);
    view.covariance = d * result.covariance * d.transpose();
    view.sigma_deg = std::sqrt(view.covariance.topLeftCorner<3, 3>().trace()) / kRadPerDeg;
    view.sigma_m = std::sqrt(view.covariance.bottomRightCorner<3, 3>().trace());
    const Eigen::MatrixXd shift = d.bottomRows(3);
    const double total = view.sigma_m * view.sigma_m;
    const auto share = [&](const Eigen::MatrixXd& part) { return (shift * part * shift.transpose()).trace() / total; };
    view.shares = {share(by_contour), share(by_tags), share(by_lens), share(by_angles), share(by_mesh)};
    view.silhouette_px = median_distance_px(fit.silhouettes[v].rows);
    view.explained = explained_share(fit.silhouettes[v], fit.scale_px);
    view.tag_rms_px = problem.tag_rms_px(fit.model, v);
    result.views.push_back(view);
  }
}

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

}  // namespace

const char* VarianceShares::dominant() const {
  const std::array<std::pair<double, const char*>, 5> all{
      {{contour, "contour"}, {tags, "tags"}, {lens, "lens"}, {angles, "angles"}, {mesh, "mesh"}}};
  return std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; })->second;
}

TurntableRegistration register_turntable(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                         const TurntableStart& start, const std::vector<TagDescription>& tags,
                                         const std::vector<TagObservation>& observations, const TurntableOptions& options) {
  check(views, start, mesh, options);
  TurntableProblem problem(mesh, views, start, corners_of(tags, observations, views.size()), options);
  const std::vector<TurntableModel> starts = placements(mesh, views, start, options);
  const double z = starts[0].camera_from_mesh.centre_in_camera.z(), px_per_m = focal_px(start.camera) / z;
  const double radius_px = mesh.extent().radius_m * px_per_m;
  const double coarse_scale_px = starts.size() > 1 ? radius_px / 10.0 : 10.0;
  RimModel rim = options.model.value_or(RimModel::Smooth);
  const TurntableModel* best = &starts[0];
  double most = -1.0;
  for (const TurntableModel& model : starts) {
    const double explained = explained_by(problem.silhouettes(model, 4.0 * coarse_scale_px, radius_px / 20.0, rim), coarse_scale_px);
    if (explained <= most) continue;
    most = explained;
    best = &model;
  }
  JointFit fit = refine_jointly(problem, *best, px_per_m, {coarse_scale_px, std::max(2.0, radius_px / 30.0), rim, 1.0, 25});
  double outline_px = 0.0;
  for (const SilhouetteEquations& one : fit.silhouettes) outline_px += one.outline_px;
  JointOptions fine{std::max(3.0, fit.scale_px), std::max(1.0, outline_px / static_cast<double>(options.rim_points)), rim, 1.0, 40};
  fit = refine_jointly(problem, fit.model, px_per_m, fine);
  if (!options.model) {
    JointOptions facets = fine;
    facets.rim = RimModel::Facets;
    facets.start_scale_px = 3.0;
    const JointFit other = refine_jointly(problem, fit.model, px_per_m, facets);
    if (other.sigma_px < kClearlyBetter * fit.sigma_px && other.explained >= 0.98 * fit.explained) {
      fit = other;
      rim = fine.rim = RimModel::Facets;
    }
  }
  TurntableRegistration result;
  result.unknowns = problem.unknowns;
  result.rim = rim;
  if (all_rows(fit.silhouettes).size() < kLeastRows) {
    result.problem = "no contours within reach of the mesh's outline";
    return result;
  }
  // Correlated contour errors weigh less against tags and priors than their number says: once more with that weight.
  const double reach_m = kCorrelationReach * mesh.extent().radius_m;
  WeightedResiduals rows = problem.weighted_rows(fit.model, fit.silhouettes, fit.scale_px);
  const double shared_sq = kSharedError_px * kSharedError_px / static_cast<double>(views.size());
  fine.correlation = std::max(1.0, rows.weight.sum() * (1.0 / correlated_scores(rows, reach_m).independent +
                                                        shared_sq / std::pow(std::max(fit.sigma_px, 0.02), 2)));
  fine.start_scale_px = fit.scale_px;
  fit = refine_jointly(problem, fit.model, px_per_m, fine);
  rows = problem.weighted_rows(fit.model, fit.silhouettes, fit.scale_px);
  const FitCovariance scores = correlated_scores(rows, reach_m);
  const Information all = problem.information(fit.model, fit.silhouettes, fit.scale_px, fit.per_px, fit.swell_sigma_m);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(problem.unknowns.count, problem.unknowns.count);
  const Eigen::VectorXd unit = all.sum().diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = unit.asDiagonal() * all.sum() * unit.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const Eigen::MatrixXd bread = unit.asDiagonal() * scaled.ldlt().solve(identity) * unit.asDiagonal();
  const Eigen::MatrixXd shared = shared_sq * rows.weight.sum() * fit.per_px * all.contour;
  fill_views(problem, fit, bread, all, fit.per_px * fit.per_px * scores.meat + shared, result);
  result.model = fit.model;
  result.independent = scores.independent;
  const Eigen::MatrixXd per_length = all.contour / (fit.per_px * rows.weight.sum());
  // Tags tell camera and axis, so what they say counts too, for all but the mesh's own turn on the table.
  result.ambiguities = undetermined_turns(reduced_to_pose(per_length + (all.sum() - all.contour) / (fit.per_px * rows.weight.sum())),
                                          fit.model.camera_from_mesh.rotation, mesh.extent().radius_m, px_per_m, options.least_turn_share);
  result.converged = fit.converged && fit.explained > kLeastExplained;
  if (fit.explained <= kLeastExplained) result.problem = "most of the mesh's outline lies on no contour";
  else if (result.ambiguous()) result.problem = "the silhouettes do not determine the turn about an axis of the mesh";
  else if (!fit.converged) result.problem = "no convergence";
  return result;
}

}  // namespace lumitexel
