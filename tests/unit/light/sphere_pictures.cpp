#include "tests/unit/light/sphere_pictures.h"

#include <Eigen/LU>
#include <fstream>

#include "processing/calibration/lens/rig_camera.h"
#include "rig/new_session.h"
#include "rig/rig_file.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"
#include "sim/simulated_rig.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

constexpr const char* kPlanHead = R"toml(name = "spheres"
mesh = "scan"
gain_db = 0.0
darks_per_exposure = 2
[exposures]
bracket_s = [0.032]
gray_card_s = [0.032]
silhouette_s = 0.02
spheres_ring_s = 0.0005
spheres_point_s = 0.00005
[gray_card]
light_azimuth_deg = 17.8
light_elevation_deg = 25.4
)toml";

struct Place {
  double turntable_deg, azimuth_deg, elevation_deg;
};
constexpr Place kPlaces[] = {{0.0, 53.3, 13.5}, {90.0, -71.1, 19.3}, {180.0, -20.0, 55.0}, {270.0, 17.8, 25.4}};

std::string plan_text(int views) {
  std::string text = kPlanHead;
  for (int v = 0; v < views; ++v) {
    const Place& place = kPlaces[v];
    text += "[[views]]\nname = \"view_" + std::to_string(v) + "\"\nsplit = \"fit\"\nturntable_deg = " +
            std::to_string(place.turntable_deg) + "\nlight_azimuth_deg = " + std::to_string(place.azimuth_deg) +
            "\nlight_elevation_deg = " + std::to_string(place.elevation_deg) + '\n';
  }
  return text;
}

std::string rig_text(const std::string& changes, int pixels, const TemporaryFolder& folder) {
  std::ofstream file(folder / "rig.toml");
  file << "base = \"" << LUMITEXEL_SOURCE_DIR << "/config/rigs/simulated.toml\"\ncamera.height_px = " << 200 * pixels << '\n';
  if (pixels > 1) {
    file << "camera.width_px = " << 1024 * pixels << "\ncamera.focal_px = [" << 2950.0 * pixels << ", " << 2950.0 * pixels
         << "]\ncamera.principal_px = [" << 516.3 * pixels << ", " << 379.8 * pixels << "]\n";
  }
  file << changes;
  file.close();
  return read_rig_file(folder / "rig.toml");
}

bool of_spheres(const Shot& shot, double ring_s, double point_s) {
  const double exposure_s = shot.camera.exposure_s;
  return shot.kind == ShotKind::SpheresRing || shot.kind == ShotKind::SpheresPoint ||
         (shot.kind == ShotKind::Dark && (std::abs(exposure_s - ring_s) < 1e-9 || std::abs(exposure_s - point_s) < 1e-9));
}

}  // namespace

double PicturedLights::error_m(std::size_t view) const {
  return (lights.spheres.lights[view].position - rig.camera.camera_from_rig * true_in_rig[view]).norm();
}

double PicturedLights::squared_sigmas(std::size_t view) const {
  const MeasuredLight& light = lights.spheres.lights[view];
  const Eigen::Vector3d error = light.position - rig.camera.camera_from_rig * true_in_rig[view];
  return error.dot(light.covariance.inverse() * error);
}

PicturedLights photograph_spheres(const std::string& changes, int views, int pixels) {
  const TemporaryFolder folder;
  SessionContent content;
  content.documents["rig.toml"] = rig_text(changes, pixels, folder);
  content.documents["plan.toml"] = plan_text(views);
  const RigDescription rig = parse_rig(content.documents["rig.toml"], "rig.toml");
  const CapturePlan plan = parse_plan(content.documents["plan.toml"], "plan.toml");
  for (const Shot& shot : schedule_shots(plan, rig, "plan.toml")) {
    if (of_spheres(shot, plan.spheres_ring_exposure_s, plan.spheres_point_exposure_s)) content.shots.push_back(shot);
  }
  const auto world = build_world(rig, "rig.toml");
  SessionStore session = begin_session(folder / "session", content);
  RigDevices devices = make_simulated_devices(rig, world);
  NoProgress quiet;
  take_missing_shots(session, devices, quiet, {});

  const CapturedFrames frames(session);
  const LinearSensor sensor = linear_sensor(rig.camera, plan.gain_db);
  const RadianceReader reader(frames, frames.master_darks(sensor), {sensor, std::nullopt, true});
  std::vector<ViewFrames> records(plan.views.size());
  for (std::size_t v = 0; v < records.size(); ++v) {
    records[v].spheres = {frames.of(ShotKind::SpheresRing, plan.views[v].name)[0],
                          frames.of(ShotKind::SpheresPoint, plan.views[v].name)[0]};
  }
  std::vector<SphereShots> shots;
  for (const ViewFrames& view : records) shots.push_back(view.spheres);
  const CameraModel camera = camera_model_of(rig.camera);
  const SphereHighlights seen = read_sphere_highlights(reader, shots, camera, rig, quiet);
  const LightSolution solution = measure_lights(seen, camera, rig);
  PicturedLights result{seen, align_lights(solution, records, plan, rig, rig.camera.camera_from_rig),
                        locate_stray_lights(seen, camera, rig), {}, rig};
  for (const PlannedView& view : plan.views) {
    result.true_in_rig.push_back(world->point_light_in_rig(view.light_azimuth_deg, view.light_elevation_deg));
  }
  return result;
}

}  // namespace lumitexel
