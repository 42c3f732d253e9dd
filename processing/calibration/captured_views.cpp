#include "processing/calibration/captured_views.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "drivers/error.h"
#include "processing/calibration/calibrated_views_file.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/light/sphere_shots.h"
#include "processing/calibration/pose/joint_refinement.h"
#include "processing/calibration/pose/object_mask.h"
#include "processing/calibration/session_card.h"
#include "processing/calibration/session_joint.h"
#include "processing/calibration/session_lamp.h"
#include "processing/calibration/session_lens.h"
#include "processing/calibration/session_lights.h"
#include "processing/calibration/session_poses.h"
#include "processing/calibration/session_sensor.h"
#include "processing/calibration/session_strays.h"
#include "processing/calibration/session_tags.h"
#include "processing/image/demosaic.h"
#include "rig/sha256.h"

namespace lumitexel {
namespace {

// Part of the key: change it with anything that changes what a calibration gives.
constexpr const char* kMethod = "captured calibration 9";
// Room for the mask about the mesh's picture: a coarse mesh's error, and that of a pose that nobody measured.
constexpr int kRegisteredMargin_px = 4, kNominalMargin_px = 8;

double seconds_between(const FrameRecord& first, const FrameRecord& later) {
  return 1e-9 * static_cast<double>(later.utc_ns - first.utc_ns);
}

const FrameRecord& middle_of(const std::vector<FrameRecord>& bracket) { return bracket[bracket.size() / 2]; }

// One session's calibration, step by step; each step's result is what the next ones need.
class SessionCalibration {
 public:
  SessionCalibration(const SessionStore& session, const CapturedInputs& in, std::filesystem::path directory,
                     const CalibrationOptions& options, Progress& progress)
      : in_(in), directory_(std::move(directory)), options_(options), progress_(progress), frames_(session),
        records_(frames_of_views(frames_, in.plan)),
        reader_(measure_sensor(frames_, in, records_, options, summary_, progress)),
        lens_(measure_lens(frames_, in, reader_, options, directory_, summary_, progress)) {
    if (lens_.vignetting) reader_.take_out(*lens_.vignetting);
    if (records_.empty()) return;
    tags_ = detect_session_tags(reader_, records_, in.rig.tags, lens_.camera, progress);
    poses_ = measure_poses(in, records_, reader_, lens_, tags_, options, summary_, progress);
    take_lens_of_poses();
  }

  std::pair<CalibratedSession, CalibrationSummary> run() {
    calibrated_.channels = mosaic_channels(in_.rig.camera.limits.mosaic);
    if (records_.empty()) return {std::move(calibrated_), std::move(summary_)};  // a session for the lens alone
    const SessionLights lights = measure_lights_of_views();
    const LampPattern pattern = measure_lamp_pattern(frames_, in_, reader_, lens_, lights, *strays_, options_, summary_);
    const SessionCard card(in_, lens_.camera, tags_, options_);
    summary_.lamp.card_source = card.posed() ? "tags" : "rig description";
    const TimedReading card_bracket = read_card_bracket(card, lights);
    note_strays(card_bracket);
    make_views(lights);
    const std::vector<TimedReading> readings = make_photographs(card, lights);
    give_intensity(measure_lamp(in_, lights, pattern, readings, card_bracket, options_, summary_));
    return {std::move(calibrated_), std::move(summary_)};
  }

 private:
  // Poses and lens were found together and make up for each other: neither is right with another.
  void take_lens_of_poses() {
    if (!poses_.camera) return;
    lens_.camera = *poses_.camera;
    lens_.covariance = poses_.lens_covariance;
    summary_.lens.notes.emplace_back("refined together with the poses");
    state_lens(lens_, summary_.lens);
  }

  Eigen::Isometry3d rig_from_world(std::size_t v) const {
    return in_.rig.camera.camera_from_rig.inverse() * poses_.camera_from_world[v];
  }

  SessionLights measure_lights_of_views() {
    std::vector<SphereShots> shots;
    for (const ViewFrames& view : records_) shots.push_back(view.spheres);
    const SphereHighlights seen = read_sphere_highlights(reader_, shots, lens_.camera, in_.rig, progress_);
    const LightSolution spheres = refine_jointly(seen, in_, options_, lens_, poses_, summary_);
    SessionLights lights = align_lights(spheres, records_, in_.plan, in_.rig, in_.rig.camera.camera_from_rig);
    summary_.spheres_seen = static_cast<int>(seen.rings.size());
    note_lamp_size(seen);
    strays_.emplace(seen, lights, lens_.camera, in_.rig);
    summary_.sphere_residual_px = spheres.residual_px;
    summary_.sphere_sigma_scale = spheres.sigma_scale;
    summary_.arm_scatter_m = lights.arm.scatter_m();
    summary_.arm_residual_m = lights.arm.residual_m();
    return lights;
  }

  void note_lamp_size(const SphereHighlights& seen) {
    LampSummary& lamp = summary_.lamp;
    lamp.radius_m = seen.lamp.radius_m;
    if (lamp.radius_m != in_.rig.light_positioner.lamp_radius_m) lamp.radius_source = "highlights";
    if (!seen.size.measured) return;
    if (seen.size.resolved) {
      lamp.highlights_radius_found = seen.size.found;
      lamp.highlights_radius_m = seen.size.radius_m;
      lamp.highlights_radius_sigma_m = seen.size.sigma_m;
    } else {
      lamp.highlights_radius_bound_m = seen.size.upper_m;
    }
  }

  static LitPlace place_of(const CardReading& reading) { return {reading.card_in_rig, reading.normal_in_rig}; }

  void note_strays(const TimedReading& card) {
    std::vector<std::string> names;
    for (const PlannedView& view : in_.plan.views) names.push_back(view.name);
    summary_.stray_lights = strays_->summarise(names, place_of(*card.reading), card.light_in_rig);
  }

  TimedReading read_card_bracket(const SessionCard& card, const SessionLights& lights) const {
    const std::vector<FrameRecord> bracket = frames_.of(ShotKind::GrayCard);
    const ArmPrediction light = lights.arm.predict(bracket[0].light_azimuth_deg, bracket[0].light_elevation_deg);
    TimedReading timed{seconds_between(records_[0].bracket[0], middle_of(bracket)), light.position_in_rig,
                       card.read(reader_.read(bracket), light)};
    if (!timed.reading) {
      throw BadInput("gray card", "not usable in its own bracket: out of sight, turned away, dark or saturated",
                     "a card in the camera's sight that faces camera and light, and exposures that suit it");
    }
    timed.stray_shares = strays_->shares(place_of(*timed.reading), light.position_in_rig);
    return timed;
  }

  // Of a light's place in the world, per axis: its own, what all lights share, and what its view's pose adds. Fills in the
  // lights' shares.
  std::vector<double> light_sigmas(const SessionLights& lights) {
    const double shared2 = lights.shared_sigma_m * lights.shared_sigma_m;
    const Eigen::Matrix3d turn = in_.rig.camera.camera_from_rig.linear();
    std::vector<LightInCamera> in_camera;
    double own2 = 0.0;
    for (std::size_t v = 0; v < records_.size(); ++v) {
      const ArmPrediction& light = lights.in_rig[v];
      in_camera.push_back({v, in_.rig.camera.camera_from_rig * light.position_in_rig,
                           turn * light.covariance * turn.transpose() + shared2 * Eigen::Matrix3d::Identity(),
                           lights.spheres.lights[v].with_lens});
      own2 += light.covariance.trace() / 3.0 / static_cast<double>(records_.size());
    }
    std::vector<double> sigmas;
    double pose2 = 0.0;
    if (poses_.registration) {
      for (const LightInMesh& light : lights_in_mesh(*poses_.registration, in_camera)) {
        sigmas.push_back(per_axis_sigma(light.covariance));
        pose2 += light.pose_share * light.covariance.trace() / 3.0 / static_cast<double>(records_.size());
      }
    } else {
      for (const LightInCamera& light : in_camera) sigmas.push_back(per_axis_sigma(light.covariance));
    }
    const double total = own2 + shared2 + pose2;
    summary_.shares.push_back({"light positions", "highlights and arm", own2 / total});
    summary_.shares.push_back({"light positions", "sphere line", shared2 / total});
    summary_.shares.push_back({"light positions", "poses", pose2 / total});
    return sigmas;
  }

  // Cameras, poses and lights; intensities follow once all photographs have shown the card.
  void make_views(const SessionLights& lights) {
    const std::vector<double> sigmas = light_sigmas(lights);
    for (std::size_t v = 0; v < records_.size(); ++v) {
      const Eigen::Isometry3d world_from_rig = rig_from_world(v).inverse();
      LightSummary light = lights.summaries[v];
      light.sigma_m = sigmas[v];
      light.position_in_world = world_from_rig * light.position_in_world;
      if (light.spheres_alone_sigma_m > 0) light.spheres_alone_in_world = world_from_rig * light.spheres_alone_in_world;
      View& view = calibrated_.views.emplace_back();
      view.name = in_.plan.views[v].name;
      view.heldout = in_.plan.views[v].heldout;
      view.camera = lens_.camera;
      view.camera_from_world = poses_.camera_from_world[v];
      view.light = {Light::Type::Point, light.position_in_world, {}, light.sigma_m};
      view.photograph = directory_ / (view.name + ".exr");
      summary_.lights.push_back(std::move(light));
    }
  }

  // Writes every view's photograph and reads the card in it on the way.
  std::vector<TimedReading> make_photographs(const SessionCard& card, const SessionLights& lights) {
    std::vector<TimedReading> readings(records_.size());
    std::atomic<int> done{0}, without_silhouette{0};
    progress_.begin("radiance", static_cast<std::int64_t>(records_.size()), "views");
    tbb::parallel_for(std::size_t{0}, records_.size(), [&](std::size_t v) {
      const MosaicRadiance merged = reader_.read(records_[v].bracket);
      note_darks(merged);
      readings[v] = {seconds_between(records_[0].bracket[0], middle_of(records_[v].bracket)),
                     lights.in_rig[v].position_in_rig, card.read(merged, lights.in_rig[v])};
      TimedReading& timed = readings[v];
      if (timed.reading) timed.stray_shares = strays_->shares(place_of(*timed.reading), timed.light_in_rig, v);
      if (!write_photograph(merged, records_[v], calibrated_.views[v])) ++without_silhouette;
      progress_.update(++done);
    });
    summary_.views_without_silhouette = without_silhouette;
    return readings;
  }

  // True if the silhouette told the mask.
  bool write_photograph(const MosaicRadiance& merged, const ViewFrames& records, const View& view) const {
    RadianceImage photograph = demosaic(merged);
    const ObjectMask mask = find_object(reader_.read(records.silhouette), in_.mesh, view.camera, view.camera_from_world,
                                        poses_.registered ? kRegisteredMargin_px : kNominalMargin_px);
    for (std::size_t i = 0; i < photograph.flags.size(); ++i) {
      if (!mask.inside[i]) photograph.flags[i] |= kPixelOutside;
    }
    write_radiance_image(view.photograph, photograph);
    return mask.from_silhouette;
  }

  void note_darks(const MosaicRadiance& merged) {
    const std::lock_guard lock(noting_);
    SensorSummary& sensor = summary_.sensor;
    sensor.brackets_with_drifted_darks += merged.darks_drifted;
    if (!merged.dark_scale.needed) return;
    ++sensor.brackets_with_scaled_darks;
    const double scale = merged.dark_scale.scale;
    sensor.least_dark_scale = std::min(sensor.least_dark_scale.value_or(scale), scale);
    sensor.largest_dark_scale = std::max(sensor.largest_dark_scale.value_or(scale), scale);
  }

  void give_intensity(const SessionLamp& lamp) {
    for (std::size_t v = 0; v < calibrated_.views.size(); ++v) {
      Light& light = calibrated_.views[v].light;
      light.intensity = lamp.intensity[v];
      light.pattern = lamp.pattern;
      light.radius_m = summary_.lamp.radius_m;
      light.lamp_from_world = lamp.lamp_from_rig[v] * rig_from_world(v).linear();
    }
    calibrated_.gray_card_scale_sigma = lamp.scale_sigma;
  }

  const CapturedInputs& in_;
  std::filesystem::path directory_;
  const CalibrationOptions& options_;
  Progress& progress_;
  CalibrationSummary summary_;
  CapturedFrames frames_;
  std::vector<ViewFrames> records_;
  RadianceReader reader_;
  SessionLens lens_;
  std::vector<std::vector<DetectedTag>> tags_;
  SessionPoses poses_;
  std::optional<SessionStrays> strays_;
  CalibratedSession calibrated_;
  std::mutex noting_;
};

}  // namespace

std::pair<CalibratedSession, CalibrationSummary> calibrate_captured(const SessionStore& session, Progress& progress,
                                                                    const CalibrationOptions& options) {
  CapturedInputs in = read_captured_inputs(session);
  const std::string key = sha256_hex(session.content_sha256() + kMethod + options.key());
  const std::filesystem::path directory = session.derived_directory() / "calibrated" / key;
  auto result = read_calibrated_views(directory);
  if (!result) {
    std::filesystem::create_directories(directory);
    result = SessionCalibration(session, in, directory, options, progress).run();
    result->first.key = key;
    write_calibrated_views(directory, result->first, result->second);
  }
  result->first.mesh = std::move(in.mesh);
  return std::move(*result);
}

}  // namespace lumitexel
