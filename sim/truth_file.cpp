#include <tbb/parallel_for.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/surface/mesh_file.h"
#include "rig/schedule.h"
#include "sim/board_placements.h"
#include "sim/placed_scene.h"
#include "sim/point_lamp.h"
#include "sim/session_drift.h"
#include "sim/simulated_rig.h"
#include "sim/simulated_world.h"

namespace lumitexel {
namespace {

using nlohmann::json;

json rows_of(const Eigen::Isometry3d& pose) {
  json rows = json::array();
  for (int i = 0; i < 4; ++i) rows.push_back({pose(i, 0), pose(i, 1), pose(i, 2), pose(i, 3)});
  return rows;
}

json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// An intensity per channel in the unit of the photographs (samples per second at 0 dB): what a perfect calibration would
// find from the gray card.
json in_photographs(const SimulatedWorld& world, const Eigen::Array3d& w_per_sr) {
  const double dn_per_s_per_radiance =
      world.settings.response_e_per_s_per_radiance / world.rig.camera.sensor.electrons_per_dn;
  const Eigen::Array3d intensity = dn_per_s_per_radiance * w_per_sr;
  if (world.rig.camera.limits.mosaic == Mosaic::Mono) return {intensity.mean()};
  return {intensity[0], intensity[1], intensity[2]};
}

// What the session's course does to a view or the card: as at the middle one of its bracket's shots.
class Course {
 public:
  Course(const SimulatedWorld& world, const RigDescription& described, const CapturePlan& plan)
      : behaviour_(world.settings), drifts_(behaviour_.lamp_drift != 0.0 || behaviour_.sensor_warming_k != 0.0) {
    if (drifts_) shots_ = schedule_shots(plan, described, "the plan");
  }
  double lamp_strength(ShotKind kind, const std::string& view) const {
    return drifts_ ? lamp_strength_at(behaviour_, middle_shot(kind, view)) : 1.0;
  }
  double temperature_c(ShotKind kind, const std::string& view) const {
    return behaviour_.sensor_temperature_c + (drifts_ ? sensor_warming_at(behaviour_, middle_shot(kind, view)) : 0.0);
  }

 private:
  std::uint64_t middle_shot(ShotKind kind, const std::string& view) const {
    std::vector<std::uint64_t> ids;
    for (const Shot& shot : shots_) {
      if (shot.kind == kind && shot.view == view) ids.push_back(static_cast<std::uint64_t>(shot.id));
    }
    return ids.empty() ? 1 : ids[ids.size() / 2];
  }

  BenchBehaviour behaviour_;
  bool drifts_;
  std::vector<Shot> shots_;
};

json true_light(const SimulatedWorld& world, const PlannedView& view, const Course& course) {
  const Eigen::Isometry3d mesh_from_rig = world.mesh_from_rig(view.turntable_deg);
  const Eigen::Vector3d light = mesh_from_rig * world.point_light_in_rig(view.light_azimuth_deg, view.light_elevation_deg);
  const Eigen::Vector3d axis =
      mesh_from_rig.linear() * lamp_axis_in_rig(world, view.light_azimuth_deg, view.light_elevation_deg);
  const Eigen::Array3d intensity =
      course.lamp_strength(ShotKind::Object, view.name) * world.settings.point_light_w_per_sr;
  return {{"view", view.name},
          {"position_m", numbers(light)},
          {"intensity_w_per_sr", {intensity[0], intensity[1], intensity[2]}},
          {"intensity", in_photographs(world, intensity)},
          {"axis", numbers(axis)},
          {"sensor_temperature_c", course.temperature_c(ShotKind::Object, view.name)},
          {"sigma_m", 0.0}};
}

json true_pose(const SimulatedWorld& world, const PlannedView& view) {
  return {{"view", view.name},
          {"camera_from_world",
           rows_of(world.rig.camera.camera_from_rig * world.mesh_from_rig(view.turntable_deg).inverse())},
          {"sigma_m", 0.0},
          {"sigma_deg", 0.0},
          {"silhouette_px", 0.0}};
}

json true_boards(const SimulatedWorld& world, const CapturePlan& plan) {
  json boards = json::array();
  for (int placement = 1; plan.lens && placement <= plan.lens->board_placements; ++placement) {
    const BoardPlacement board = board_placement(world, placement);
    boards.push_back(
        {{"placement", placement}, {"camera_from_board", rows_of(board.camera_from_board)}, {"bow_m", board.bow_m}});
  }
  return boards;
}

json true_lamp(const SimulatedWorld& world) {
  const SimulationSettings& settings = world.settings;
  return {{"pattern_exponent", settings.lamp_pattern_exponent},
          {"pattern_tilt_deg", {settings.lamp_pattern_tilt_deg.x(), settings.lamp_pattern_tilt_deg.y()}},
          {"radius_m", settings.lamp_radius_m},
          {"drift", settings.lamp_drift}};
}

json true_camera(const CameraModel& camera) {
  const json params = {camera.focal_x_px, camera.focal_y_px, camera.principal_x_px, camera.principal_y_px,
                       camera.k1,         camera.k2,         camera.p1,             camera.p2};
  return {{"model", "OPENCV"}, {"params", params}, {"reprojection_px", 0.0}};
}

// Code above black over full scale, for 0, 1, … 64 sixty-fourths of the full well.
json true_response(const SimulatedWorld& world) {
  json curve = json::array();
  for (int i = 0; i <= 64; ++i) curve.push_back(response_at(world.settings.response, i / 64.0));
  return {{"family", to_string(world.settings.response)}, {"curve", curve}};
}

json true_calibration(const SimulatedWorld& world, const RigDescription& described, const CapturePlan& plan) {
  const Course course(world, described, plan);
  json lights = json::array(), poses = json::array();
  for (const PlannedView& view : plan.views) {
    lights.push_back(true_light(world, view, course));
    poses.push_back(true_pose(world, view));
  }
  const RigDescription& rig = world.rig;
  const GrayCardDescription& card = rig.gray_card;
  const double at_card = course.lamp_strength(ShotKind::GrayCard, "");
  return {{"lights", lights},
          {"poses", poses},
          {"camera", true_camera(world.camera)},
          {"scale", {{"value", in_photographs(world, at_card * world.settings.point_light_w_per_sr)}, {"sigma", 0.0}}},
          {"vignetting", numbers(world.settings.vignetting)},
          {"camera_from_rig", rows_of(rig.camera.camera_from_rig)},
          {"turntable",
           {{"axis_point_m", numbers(rig.turntable.axis_point_in_rig)},
            {"axis_direction", numbers(rig.turntable.axis_direction_in_rig)}}},
          {"table_from_world", rows_of(world.table_from_mesh)},
          {"card",
           {{"centre_m", numbers(card.centre_in_rig)},
            {"normal", numbers(card.normal_in_rig)},
            {"up", numbers(card.up_in_rig)},
            {"lamp_strength", at_card}}},
          {"lamp", true_lamp(world)},
          {"boards", true_boards(world, plan)},
          {"response", true_response(world)}};
}

// Normal and material (1 for the first; 0: not the object) at every pixel's centre.
struct SurfaceTruth {
  Image normal, material;
};

SurfaceTruth surface_seen(const SimulatedWorld& world, double turntable_deg) {
  const int width = world.camera.width_px, height = world.camera.height_px;
  SurfaceTruth truth{Image(width, height, 3), Image(width, height, 1)};
  const PlacedScene scene(world, turntable_deg);
  const Eigen::Isometry3d mesh_from_camera = scene.mesh_from_rig() * world.rig.camera.camera_from_rig.inverse();
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector3d in_camera = world.camera.unproject(Eigen::Vector2d(x + 0.5, y + 0.5));
      const SceneHit hit = scene.closest(mesh_from_camera.translation(), mesh_from_camera.linear() * in_camera);
      if (hit.part != ScenePart::Object) continue;
      for (int c = 0; c < 3; ++c) truth.normal.at(x, y, c) = static_cast<float>(hit.normal[c]);
      truth.material.at(x, y) = static_cast<float>(world.pattern.at(hit.point).dominant() + 1);
    }
  });
  return truth;
}

}  // namespace

void write_truth(const SimulatedWorld& world, const RigDescription& rig, const CapturePlan& plan,
                 const std::filesystem::path& truth_directory) {
  std::error_code failure;
  std::filesystem::create_directories(truth_directory, failure);
  if (failure) throw Error(truth_directory.string() + ": cannot be created: " + failure.message());
  const std::filesystem::path calibration = truth_directory / "calibration.json";
  std::ofstream stream(calibration);
  stream << true_calibration(world, rig, plan).dump(1) << '\n';
  stream.close();
  if (!stream) throw Error(calibration.string() + ": cannot be written");
  write_ply(truth_directory / "mesh.ply", world.object);
  for (const PlannedView& view : plan.views) {
    const SurfaceTruth seen = surface_seen(world, view.turntable_deg);
    write_exr_colour(truth_directory / (view.name + "_normal.exr"), seen.normal, ExrPixel::Half);
    write_exr_colour(truth_directory / (view.name + "_material.exr"), seen.material, ExrPixel::Half);
  }
}

}  // namespace lumitexel
