#include "processing/calibration/captured_views.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "drivers/error.h"
#include "processing/calibration/calibrated_views_file.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/light/gray_card.h"
#include "processing/calibration/pose/object_mask.h"
#include "processing/calibration/session_lights.h"
#include "processing/calibration/light/sphere_shots.h"
#include "processing/image/demosaic.h"
#include "processing/image/hdr_merge.h"
#include "rig/sha256.h"

namespace lumitexel {
namespace {

// Part of the key: change it with anything that changes what a calibration gives.
constexpr const char* kMethod = "captured calibration 2";
constexpr int kMaskMarginPx = 8;  // a coarse mesh's error and the pose's, in pixels, with room

struct Scale {
  std::vector<double> intensity;
  double sigma = 0;  // relative
};

Scale absolute_scale(const CapturedInputs& in, const CapturedFrames& frames, const DarkLibrary& darks,
                     const SessionLights& lights, CalibrationSummary& summary) {
  const std::vector<FrameRecord> bracket = frames.of(ShotKind::GrayCard);
  const ArmPrediction light = lights.arm.predict(bracket[0].light_azimuth_deg, bracket[0].light_elevation_deg);
  const MosaicRadiance card = merge_bracket(frames.load(bracket), darks, in.nominal_sensor);
  const GrayCardIntensity measured =
      measure_gray_card(card, in.nominal_camera, in.rig.camera.camera_from_rig, in.rig.gray_card, light.position_in_rig);
  Scale scale{measured.intensity, *std::max_element(measured.relative_sigma.begin(), measured.relative_sigma.end())};
  // Intensity goes with the distance squared.
  const double distance_m = (light.position_in_rig - in.rig.gray_card.centre_in_rig).norm();
  scale.sigma =
      std::hypot(scale.sigma, 2.0 * std::hypot(per_axis_sigma(light.covariance), lights.shared_sigma_m) / distance_m);
  summary.intensity = measured.intensity;
  summary.gray_card_pixel_scatter = measured.pixel_scatter;
  summary.scale_sigma = scale.sigma;
  return scale;
}

void apply_mask(const ObjectMask& mask, RadianceImage& image) {
  for (std::size_t i = 0; i < image.flags.size(); ++i) {
    if (!mask.inside[i]) image.flags[i] |= kPixelOutside;
  }
}

// The view's photograph, written; true if the silhouette told the mask.
bool make_photograph(const CapturedInputs& in, const CapturedFrames& frames, const DarkLibrary& darks,
                     const ViewFrames& records, const View& view) {
  RadianceImage photograph = demosaic(merge_bracket(frames.load(records.bracket), darks, in.nominal_sensor));
  const ObjectMask mask = find_object(merge_bracket({frames.load(records.silhouette)}, darks, in.nominal_sensor), in.mesh,
                                      in.nominal_camera, view.camera_from_world, kMaskMarginPx);
  apply_mask(mask, photograph);
  write_radiance_image(view.photograph, photograph);
  return mask.from_silhouette;
}

std::vector<View> make_views(const CapturedInputs& in, const std::vector<ViewFrames>& frames,
                             const std::vector<LightSummary>& lights, const Scale& scale,
                             const std::filesystem::path& directory) {
  std::vector<View> views;
  for (std::size_t v = 0; v < frames.size(); ++v) {
    View view;
    view.name = in.plan.views[v].name;
    view.heldout = in.plan.views[v].heldout;
    view.camera = in.nominal_camera;
    view.camera_from_world =
        in.rig.camera.camera_from_rig * in.rig.turntable.rig_from_table(frames[v].bracket[0].turntable_deg);
    view.light = {Light::Type::Point, lights[v].position_in_world, scale.intensity, lights[v].sigma_m};
    view.photograph = directory / (view.name + ".exr");
    views.push_back(std::move(view));
  }
  return views;
}

std::pair<CalibratedSession, CalibrationSummary> measure(const SessionStore& session, const CapturedInputs& in,
                                                         const std::filesystem::path& directory, Progress& progress) {
  const CapturedFrames frames(session);
  const std::vector<ViewFrames> records = frames_of_views(frames, in.plan);
  std::pair<CalibratedSession, CalibrationSummary> result;
  auto& [calibrated, summary] = result;
  progress.begin("dark frames", 1, "sets");
  const DarkLibrary darks = frames.master_darks(in.nominal_sensor);
  for (const MasterDark& dark : darks.all()) summary.hot_pixels = std::max(summary.hot_pixels, dark.hot_count);
  progress.update(1);

  std::vector<SphereShots> sphere_shots;
  for (const ViewFrames& view : records) sphere_shots.push_back(view.spheres);
  const Eigen::Isometry3d& camera_from_rig = in.rig.camera.camera_from_rig;
  const SessionLights lights = align_lights(
      measure_lights(frames, sphere_shots, darks, in.nominal_sensor, in.nominal_camera, in.rig, progress), records,
      in.plan, in.rig, camera_from_rig);
  summary.sphere_residual_px = lights.spheres.residual_px;
  summary.sphere_sigma_scale = lights.spheres.sigma_scale;
  summary.arm_scatter_m = lights.arm.scatter_m();
  summary.arm_residual_m = lights.arm.residual_m();
  for (std::size_t v = 0; v < records.size(); ++v) {
    const Eigen::Isometry3d world_from_rig =
        in.rig.turntable.rig_from_table(records[v].spheres.point.turntable_deg).inverse();
    LightSummary light = lights.summaries[v];
    light.position_in_world = world_from_rig * light.position_in_world;
    if (light.spheres_alone_sigma_m > 0) light.spheres_alone_in_world = world_from_rig * light.spheres_alone_in_world;
    summary.lights.push_back(std::move(light));
  }

  const Scale scale = absolute_scale(in, frames, darks, lights, summary);
  calibrated.gray_card_scale_sigma = scale.sigma;
  calibrated.channels = mosaic_channels(in.rig.camera.limits.mosaic);
  calibrated.views = make_views(in, records, summary.lights, scale, directory);
  progress.begin("radiance", static_cast<std::int64_t>(records.size()), "views");
  std::atomic<int> done{0}, without_silhouette{0};
  tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t v) {
    if (!make_photograph(in, frames, darks, records[v], calibrated.views[v])) ++without_silhouette;
    progress.update(++done);
  });
  summary.views_without_silhouette = without_silhouette;
  return result;
}

}  // namespace

std::pair<CalibratedSession, CalibrationSummary> calibrate_captured(const SessionStore& session, Progress& progress,
                                                                       const CalibrationOptions& options) {
  CapturedInputs in = read_captured_inputs(session);
  const std::string key = sha256_hex(session.content_sha256() + kMethod + options.key());
  const std::filesystem::path directory = session.derived_directory() / "calibrated" / key;
  auto result = read_calibrated_views(directory);
  if (!result) {
    std::filesystem::create_directories(directory);
    result = measure(session, in, directory, progress);
    result->first.key = key;
    write_calibrated_views(directory, result->first, result->second);
  }
  result->first.mesh = std::move(in.mesh);
  return std::move(*result);
}

}  // namespace lumitexel
