#include <tbb/parallel_for.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/surface/mesh_file.h"
#include "sim/placed_scene.h"
#include "sim/simulated_rig.h"
#include "sim/simulated_world.h"

namespace lumitexel {
namespace {

using nlohmann::json;

// The point light's intensity per channel in the unit of the photographs (samples per second at 0 dB): what a perfect
// calibration would find from the gray card.
std::vector<double> light_in_photographs(const SimulatedWorld& world) {
  const double dn_per_s_per_radiance =
      world.settings.response_e_per_s_per_radiance / world.rig.camera.sensor.electrons_per_dn;
  const Eigen::Array3d intensity = dn_per_s_per_radiance * world.settings.point_light_w_per_sr;
  if (world.rig.camera.limits.mosaic == Mosaic::Mono) return {intensity.mean()};
  return {intensity[0], intensity[1], intensity[2]};
}

json true_calibration(const SimulatedWorld& world, const CapturePlan& plan) {
  json lights = json::array(), poses = json::array();
  for (const PlannedView& view : plan.views) {
    const Eigen::Isometry3d rig_from_table = world.rig.turntable.rig_from_table(view.turntable_deg);
    const Eigen::Vector3d light =
        rig_from_table.inverse() * world.point_light_in_rig(view.light_azimuth_deg, view.light_elevation_deg);
    const Eigen::Array3d& intensity = world.settings.point_light_w_per_sr;
    lights.push_back({{"view", view.name},
                      {"position_m", {light.x(), light.y(), light.z()}},
                      {"intensity_w_per_sr", {intensity[0], intensity[1], intensity[2]}},
                      {"sigma_m", 0.0}});
    const Eigen::Matrix4d pose = (world.rig.camera.camera_from_rig * rig_from_table).matrix();
    json rows = json::array();
    for (int i = 0; i < 4; ++i) rows.push_back({pose(i, 0), pose(i, 1), pose(i, 2), pose(i, 3)});
    poses.push_back({{"view", view.name},
                     {"camera_from_world", rows},
                     {"sigma_m", 0.0},
                     {"sigma_deg", 0.0},
                     {"silhouette_px", 0.0}});
  }
  const CameraModel& camera = world.camera;
  const json params = {camera.focal_x_px, camera.focal_y_px, camera.principal_x_px, camera.principal_y_px,
                       camera.k1,         camera.k2,         camera.p1,             camera.p2};
  return {{"lights", lights},
          {"poses", poses},
          {"camera", {{"model", "OPENCV"}, {"params", params}, {"reprojection_px", 0.0}}},
          {"scale", {{"value", light_in_photographs(world)}, {"sigma", 0.0}}}};
}

// Normal and material (1 for the first; 0: not the object) at every pixel's centre.
struct SurfaceTruth {
  Image normal, material;
};

SurfaceTruth surface_seen(const SimulatedWorld& world, double turntable_deg) {
  const int width = world.camera.width_px, height = world.camera.height_px;
  SurfaceTruth truth{Image(width, height, 3), Image(width, height, 1)};
  const PlacedScene scene(world, turntable_deg);
  const Eigen::Isometry3d table_from_camera = scene.table_from_rig() * world.rig.camera.camera_from_rig.inverse();
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector3d in_camera = world.camera.unproject(Eigen::Vector2d(x + 0.5, y + 0.5));
      const SceneHit hit = scene.closest(table_from_camera.translation(), table_from_camera.linear() * in_camera);
      if (hit.part != ScenePart::Object) continue;
      for (int c = 0; c < 3; ++c) truth.normal.at(x, y, c) = static_cast<float>(hit.normal[c]);
      truth.material.at(x, y) = static_cast<float>(world.pattern.at(hit.point).dominant() + 1);
    }
  });
  return truth;
}

}  // namespace

void write_truth(const SimulatedWorld& world, const RigDescription&, const CapturePlan& plan,
                 const std::filesystem::path& truth_directory) {
  std::error_code failure;
  std::filesystem::create_directories(truth_directory, failure);
  if (failure) throw Error(truth_directory.string() + ": cannot be created: " + failure.message());
  const std::filesystem::path calibration = truth_directory / "calibration.json";
  std::ofstream stream(calibration);
  stream << true_calibration(world, plan).dump(1) << '\n';
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
