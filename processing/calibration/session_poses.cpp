#include "processing/calibration/session_poses.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "processing/calibration/pose/register_turntable.h"
#include "processing/calibration/pose/silhouette_contour.h"

namespace lumitexel {
namespace {

std::vector<Eigen::Isometry3d> nominal_poses(const CapturedInputs& in, const std::vector<ViewFrames>& views) {
  std::vector<Eigen::Isometry3d> poses;
  for (const ViewFrames& view : views) {
    poses.push_back(in.rig.camera.camera_from_rig * in.rig.turntable.rig_from_table(view.bracket[0].turntable_deg));
  }
  return poses;
}

std::vector<std::optional<ContourLookup>> read_contours(const std::vector<ViewFrames>& views,
                                                        const RadianceReader& reader, Progress& progress) {
  progress.begin("silhouettes", static_cast<std::int64_t>(views.size()), "views");
  std::vector<std::optional<ContourLookup>> contours(views.size());
  std::atomic<std::int64_t> done{0};
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t v) {
    const SilhouetteContour contour = silhouette_contour(reader.read(views[v].silhouette));
    if (!contour.points.empty()) contours[v].emplace(contour);
    progress.update(++done);
  });
  return contours;
}

// At 0 degrees the table's frame is the rig's.
TurntableStart start_of(const CapturedInputs& in, const SessionLens& lens) {
  TurntableStart start;
  start.camera = lens.camera;
  start.camera_from_table = in.rig.camera.camera_from_rig;
  start.axis_in_table = in.rig.turntable.axis_direction_in_rig;
  start.axis_point_in_table = in.rig.turntable.axis_point_in_rig;
  return start;
}

std::vector<TagObservation> observations(const std::vector<std::vector<DetectedTag>>& tags) {
  std::vector<TagObservation> seen;
  for (std::size_t v = 0; v < tags.size(); ++v) {
    for (const DetectedTag& tag : tags[v]) seen.push_back({tag.id, v, tag.corners_px, tag.sigma_px});
  }
  return seen;
}

TurntableRegistration register_session(const CapturedInputs& in, const std::vector<ViewFrames>& views,
                                       const RadianceReader& reader, const SessionLens& lens,
                                       const std::vector<std::vector<DetectedTag>>& tags, Progress& progress) {
  const std::vector<std::optional<ContourLookup>> contours = read_contours(views, reader, progress);
  std::vector<TurntableView> registered;
  for (std::size_t v = 0; v < views.size(); ++v) {
    registered.push_back({contours[v] ? &*contours[v] : nullptr, views[v].bracket[0].turntable_deg});
  }
  TurntableOptions options;
  options.lens_covariance = lens.covariance;
  progress.begin("poses", 1, "fits");
  TurntableRegistration result = register_turntable(MeshSilhouette(in.mesh), registered, start_of(in, lens),
                                                    in.rig.tags, observations(tags), options);
  progress.update(1);
  return result;
}

int on_table(const std::vector<DetectedTag>& seen, const std::vector<TagDescription>& tags) {
  int count = 0;
  for (const DetectedTag& tag : seen) {
    for (const TagDescription& described : tags) count += described.id == tag.id && described.on_table;
  }
  return count;
}

PoseSummary summarise(const RegisteredView& view, const std::string& name, int tags) {
  PoseSummary pose;
  pose.view = name;
  pose.source = tags > 0 ? "silhouette and tags" : "silhouette";
  pose.sigma_m = view.sigma_m;
  pose.sigma_deg = view.sigma_deg;
  pose.silhouette_px = view.silhouette_px;
  pose.tags = tags;
  pose.dominant = view.shares.dominant();
  return pose;
}

// Squared distance of a pose from the registered one in units of the latter's covariance.
double squared_distance(const Eigen::Isometry3d& pose, const RegisteredView& view, const Eigen::Vector3d& middle) {
  const Eigen::AngleAxisd turn(pose.linear() * view.camera_from_mesh.linear().transpose());
  PoseStep step;
  step << turn.angle() * turn.axis(), pose * middle - view.camera_from_mesh * middle;
  return step.dot(view.covariance.ldlt().solve(step));
}

// Whether the views contradict the description: a pose that they do not tell from it would only add their noise.
bool contradicts(const TurntableRegistration& result, const std::vector<Eigen::Isometry3d>& nominal,
                 const Eigen::Vector3d& middle) {
  constexpr double kChiSquare6At95 = 12.592;
  std::vector<double> distances;
  for (std::size_t v = 0; v < nominal.size(); ++v) {
    distances.push_back(squared_distance(nominal[v], result.views[v], middle));
  }
  // All views share their unknowns, so they are no independent witnesses: the middle one speaks for them.
  const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), median, distances.end());
  return !(*median < kChiSquare6At95);
}

}  // namespace

SessionPoses measure_poses(const CapturedInputs& in, const std::vector<ViewFrames>& views, const RadianceReader& reader,
                           const SessionLens& lens, const std::vector<std::vector<DetectedTag>>& tags,
                           const CalibrationOptions& options, CalibrationSummary& summary, Progress& progress) {
  SessionPoses poses;
  poses.camera_from_world = nominal_poses(in, views);
  for (const PlannedView& view : in.plan.views) summary.poses.emplace_back().view = view.name;
  if (!options.takes(CalibrationStep::Pose)) return poses;
  TurntableRegistration result = register_session(in, views, reader, lens, tags, progress);
  if (!result.converged || result.ambiguous()) {
    summary.pose_problem = result.problem;
    return poses;
  }
  poses.registered = true;
  poses.replaced = contradicts(result, poses.camera_from_world, extent_of(in.mesh).centre);
  for (std::size_t v = 0; v < views.size(); ++v) {
    summary.poses[v] = summarise(result.views[v], in.plan.views[v].name, on_table(tags[v], in.rig.tags));
    if (poses.replaced) {
      poses.camera_from_world[v] = result.views[v].camera_from_mesh;
    } else {
      summary.poses[v].source = "rig description, confirmed";
    }
  }
  if (poses.replaced && result.unknowns.lens >= 0) {
    poses.camera = result.model.camera;
    poses.lens_covariance =
        result.covariance.block<kLensParameters, kLensParameters>(result.unknowns.lens, result.unknowns.lens);
  }
  poses.registration = std::move(result);
  return poses;
}

}  // namespace lumitexel
