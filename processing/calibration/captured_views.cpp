#include "processing/calibration/captured_views.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "drivers/error.h"
#include "processing/calibration/light/arm_alignment.h"
#include "processing/calibration/calibrated_views_file.h"
#include "processing/calibration/captured_frames.h"
#include "processing/calibration/light/gray_card.h"
#include "processing/calibration/pose/object_mask.h"
#include "processing/calibration/lens/rig_camera.h"
#include "processing/calibration/light/sphere_shots.h"
#include "processing/image/demosaic.h"
#include "processing/image/hdr_merge.h"
#include "processing/surface/mesh_file.h"
#include "rig/capture_plan.h"
#include "rig/sha256.h"

namespace lumitexel {
namespace {

// Part of the key: change it with anything that changes what a calibration gives.
constexpr const char* kMethod = "captured calibration 2";
constexpr int kMaskMarginPx = 8;  // a coarse mesh's error and the pose's, in pixels, with room

struct CapturedInputs {
  RigDescription rig;
  CapturePlan plan;
  Mesh mesh;
  CameraModel camera;
  LinearSensor sensor;
};

struct ViewFrames {
  std::vector<FrameRecord> bracket;
  FrameRecord silhouette;
  SphereShots spheres;
};

CapturedInputs read_inputs(const SessionStore& session) {
  CapturedInputs in;
  const std::string where = session.directory().string() + ": ";
  in.rig = parse_rig(session.document("rig.toml"), where + "rig.toml");
  in.plan = parse_plan(session.document("plan.toml"), where + "plan.toml");
  in.mesh = parse_mesh(session.document("mesh.ply"), ".ply", where + "mesh.ply");
  in.camera = camera_model_of(in.rig.camera);
  in.sensor = linear_sensor(in.rig.camera, in.plan.gain_db);
  return in;
}

std::vector<ViewFrames> frames_of_views(const CapturedFrames& frames, const CapturePlan& plan) {
  std::vector<ViewFrames> views;
  for (const PlannedView& view : plan.views) {
    views.push_back(
        {frames.of(ShotKind::Object, view.name),
         frames.of(ShotKind::Silhouette, view.name)[0],
         {frames.of(ShotKind::SpheresRing, view.name)[0], frames.of(ShotKind::SpheresPoint, view.name)[0]}});
  }
  return views;
}

std::vector<ArmSample> arm_samples(const LightSolution& solution, const std::vector<ViewFrames>& views,
                                   const Eigen::Isometry3d& rig_from_camera) {
  std::vector<ArmSample> samples;
  const Eigen::Matrix3d turn = rig_from_camera.linear();
  for (std::size_t v = 0; v < views.size(); ++v) {
    const FrameRecord& shot = views[v].spheres.point;
    samples.push_back({shot.light_azimuth_deg, shot.light_elevation_deg, rig_from_camera * solution.lights[v].position,
                       turn * solution.lights[v].own_covariance * turn.transpose()});
  }
  return samples;
}

ArmAlignment align_arm(const CapturedInputs& in, const LightSolution& solution, const std::vector<ArmSample>& all) {
  std::vector<ArmSample> measured;
  for (std::size_t v = 0; v < all.size(); ++v) {
    if (solution.lights[v].measured) measured.push_back(all[v]);
  }
  return ArmAlignment(in.rig.light_positioner, measured);
}

double per_axis_sigma(const Eigen::Matrix3d& covariance) { return std::sqrt(covariance.trace() / 3.0); }

// What the lights' errors have in common, per axis: the least over the views of what the sphere line adds.
double shared_sigma(const LightSolution& solution) {
  std::vector<double> variances;
  for (const MeasuredLight& light : solution.lights) {
    if (light.measured) variances.push_back(((light.covariance - light.own_covariance).trace()) / 3.0);
  }
  if (variances.empty()) return 0.0;
  return std::sqrt(std::max(0.0, *std::min_element(variances.begin(), variances.end())));
}

// The light of one view in the turntable's frame, and what is to be said about it.
LightSummary summarise_light(const std::string& name, const MeasuredLight& measured, const ArmSample& sample,
                             const ArmAlignment& arm, double shared_sigma_m, const Eigen::Isometry3d& table_from_rig) {
  LightSummary light;
  light.view = name;
  light.highlights = measured.highlights;
  light.outliers = measured.outliers;
  light.residual_px = measured.residual_px;
  light.off_the_arm = measured.measured && arm.is_outlier(sample);
  light.from_spheres = measured.measured && !light.off_the_arm;
  const ArmPrediction best =
      light.from_spheres ? arm.combine(sample) : arm.predict(sample.azimuth_deg, sample.elevation_deg);
  light.position_in_world = table_from_rig * best.position_in_rig;
  // An error of the sphere line is in all views alike: no number of them averages it away.
  light.sigma_m = std::hypot(per_axis_sigma(best.covariance), shared_sigma_m);
  if (measured.measured) {
    light.spheres_alone_in_world = table_from_rig * sample.position_in_rig;
    light.spheres_alone_sigma_m = per_axis_sigma(measured.covariance);
  }
  return light;
}

struct Scale {
  std::vector<double> intensity;
  double sigma = 0;  // relative
};

Scale absolute_scale(const CapturedInputs& in, const CapturedFrames& frames, const DarkLibrary& darks,
                     const ArmAlignment& arm, double shared_sigma_m, CalibrationSummary& summary) {
  const std::vector<FrameRecord> bracket = frames.of(ShotKind::GrayCard);
  const ArmPrediction light = arm.predict(bracket[0].light_azimuth_deg, bracket[0].light_elevation_deg);
  const MosaicRadiance card = merge_bracket(frames.load(bracket), darks, in.sensor);
  const GrayCardIntensity measured =
      measure_gray_card(card, in.camera, in.rig.camera.camera_from_rig, in.rig.gray_card, light.position_in_rig);
  Scale scale{measured.intensity, *std::max_element(measured.relative_sigma.begin(), measured.relative_sigma.end())};
  // Intensity goes with the distance squared.
  const double distance_m = (light.position_in_rig - in.rig.gray_card.centre_in_rig).norm();
  scale.sigma =
      std::hypot(scale.sigma, 2.0 * std::hypot(per_axis_sigma(light.covariance), shared_sigma_m) / distance_m);
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
  RadianceImage photograph = demosaic(merge_bracket(frames.load(records.bracket), darks, in.sensor));
  const ObjectMask mask = find_object(merge_bracket({frames.load(records.silhouette)}, darks, in.sensor), in.mesh,
                                      in.camera, view.camera_from_world, kMaskMarginPx);
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
    view.camera = in.camera;
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
  const DarkLibrary darks = frames.master_darks(in.sensor);
  for (const MasterDark& dark : darks.all()) summary.hot_pixels = std::max(summary.hot_pixels, dark.hot_count);
  progress.update(1);

  std::vector<SphereShots> sphere_shots;
  for (const ViewFrames& view : records) sphere_shots.push_back(view.spheres);
  const LightSolution lights = measure_lights(frames, sphere_shots, darks, in.sensor, in.camera, in.rig, progress);
  const std::vector<ArmSample> samples = arm_samples(lights, records, in.rig.camera.camera_from_rig.inverse());
  const ArmAlignment arm = align_arm(in, lights, samples);
  const double shared_sigma_m = shared_sigma(lights);
  summary.sphere_residual_px = lights.residual_px;
  summary.sphere_sigma_scale = lights.sigma_scale;
  summary.arm_scatter_m = arm.scatter_m();
  summary.arm_residual_m = arm.residual_m();
  for (std::size_t v = 0; v < records.size(); ++v) {
    const Eigen::Isometry3d table_from_rig =
        in.rig.turntable.rig_from_table(records[v].spheres.point.turntable_deg).inverse();
    summary.lights.push_back(
        summarise_light(in.plan.views[v].name, lights.lights[v], samples[v], arm, shared_sigma_m, table_from_rig));
  }

  const Scale scale = absolute_scale(in, frames, darks, arm, shared_sigma_m, summary);
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

std::pair<CalibratedSession, CalibrationSummary> calibrate_captured(const SessionStore& session, Progress& progress) {
  CapturedInputs in = read_inputs(session);
  const std::string key = sha256_hex(session.content_sha256() + kMethod);
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
