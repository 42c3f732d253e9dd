#include "rig/recorded_bench.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

// Deg per second: there at once.
constexpr double kImmediately = 1e9;

RigDescription rig_of(const SessionStore& recording) {
  const std::string where = recording.directory().string();
  if (recording.kind() != SessionKind::Captured) {
    throw BadInput(where, "an imported session, which no rig has taken", "a session made by `lumitexel capture`");
  }
  try {
    return parse_rig(recording.document("rig.toml"), where + ": rig.toml");
  } catch (const BadInput& error) {
    throw Corrupt(error.what());
  }
}

std::array<AxisLimits, 3> limits_of(const LightPositionerDescription& arm) {
  const auto limits = [](double min, double max, bool wraps) {
    return AxisLimits{min, max, kImmediately, 0.0, wraps, "deg"};
  };
  return {limits(0.0, 360.0, true), limits(arm.azimuth_min_deg, arm.azimuth_max_deg, false),
          limits(arm.elevation_min_deg, arm.elevation_max_deg, false)};
}

std::array<double, 3> positions_of(const Shot& shot) {
  return {shot.turntable_deg, shot.light_azimuth_deg, shot.light_elevation_deg};
}

// The name in "asked for frame 7, got the frame named 6", as drivers/camera.cpp says it.
std::optional<std::uint64_t> name_in(const std::string& cause) {
  constexpr std::string_view kBefore = "got the frame named ";
  const std::size_t at = cause.find(kBefore);
  std::uint64_t name = 0;
  if (at == std::string::npos) return std::nullopt;
  const char* const first = cause.data() + at + kBefore.size();
  if (std::from_chars(first, cause.data() + cause.size(), name).ec != std::errc{}) return std::nullopt;
  return name;
}

}  // namespace

RecordedBench::RecordedBench(std::shared_ptr<const SessionStore> recording, RecordedRun run)
    : recording_(std::move(recording)),
      clock_(std::make_shared<RecordedClock>(run.empty() ? 0 : run.front().first_utc_ns())) {
  for (RecordedShoot& shoot : run) shoots_.push_back({std::move(shoot)});
  const RigDescription rig = rig_of(*recording_);
  camera_limits_ = rig.camera.limits;
  camera_limits_.settings_latency_frames = 0;
  limits_ = limits_of(rig.light_positioner);
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    sent_[i] = reading_[i] = std::clamp(0.0, limits_[i].min, limits_[i].max);
  }
}

void RecordedBench::send(RecordedAxis axis, double target) {
  const auto i = static_cast<std::size_t>(axis);
  sent_[i] = reading_[i] = target;
}

Frame RecordedBench::expose(const CameraSettings& settings, std::uint64_t frame_key, std::stop_token stop) {
  Unplayed& next = find(settings, frame_key);
  if (next.discards_played < next.shoot.discards.size()) {
    const DiscardRecord& discard = next.shoot.discards[next.discards_played++];
    clock_->set_utc(discard.utc_ns, stop);
    if (!discard.reported) last_device_time_s_ = -std::numeric_limits<double>::infinity();
    return repeat_discard(discard, frame_key);
  }
  return deliver(next, stop);
}

Frame RecordedBench::deliver(Unplayed& unplayed, std::stop_token stop) {
  if (!unplayed.shoot.frame) {
    unplayed.done = true;
    throw Error(camera_name() + ": the recorded run was stopped at shot " + std::to_string(unplayed.shoot.shot.id));
  }
  const FrameRecord& record = *unplayed.shoot.frame;
  if (!(record.device_time_s > last_device_time_s_)) {
    last_device_time_s_ = -std::numeric_limits<double>::infinity();
    throw Disconnected(camera_name() + ": before shot " + std::to_string(record.shot_id) +
                       " the recorded session was interrupted and its camera connected anew");
  }
  Frame frame = load_recorded_frame(*recording_, record);
  frame.device_frame_id = ++delivered_;
  last_device_time_s_ = record.device_time_s;
  reading_ = {record.turntable_deg, record.light_azimuth_deg, record.light_elevation_deg};
  unplayed.done = true;
  clock_->set_utc(record.utc_ns, stop);
  return frame;
}

Frame RecordedBench::repeat_discard(const DiscardRecord& discard, std::uint64_t frame_key) const {
  Frame frame;
  const std::optional<std::uint64_t> name = name_in(discard.cause);
  const bool for_settings = discard.reported && !same_settings(*discard.reported, discard.asked);
  const bool for_name = discard.reported && !for_settings && name && *name != frame_key;
  // Only a frame that the camera's base class is certain to discard again may be made up.
  if (!for_settings && !for_name) throw Protocol(discard.cause);
  frame.width_px = camera_limits_.width_px;
  frame.height_px = camera_limits_.height_px;
  frame.bits = camera_limits_.bits;
  frame.mosaic = camera_limits_.mosaic;
  frame.samples.assign(static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.height_px), 0);
  frame.reported = *discard.reported;
  if (for_name) frame.echoed_key = name;
  return frame;
}

bool RecordedBench::taken_so(const RecordedShoot& shoot, const CameraSettings& settings) const {
  const CameraSettings applied = shoot.frame ? shoot.frame->applied : shoot.discards.front().asked;
  if (!same_settings(settings, applied) || lamps_ != lighting_of(shoot.shot.kind)) return false;
  if (placed_ != prop_for(shoot.shot)) return false;
  const std::array<double, 3> positions = positions_of(shoot.shot);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    // An axis that stands where it is wanted, by its own reading, is not sent there again.
    const bool there = distance_between(limits_[i], sent_[i], positions[i]) <= limits_[i].tolerance ||
                       distance_between(limits_[i], reading_[i], positions[i]) <= limits_[i].tolerance;
    if (!there) return false;
  }
  return true;
}

RecordedBench::Unplayed& RecordedBench::find(const CameraSettings& settings, std::uint64_t frame_key) {
  Unplayed* found = nullptr;
  for (Unplayed& unplayed : shoots_) {
    if (unplayed.done || !taken_so(unplayed.shoot, settings)) continue;
    const bool named = static_cast<std::uint64_t>(unplayed.shoot.shot.id) == frame_key;
    if (found == nullptr || named) found = &unplayed;
    if (named) break;
  }
  if (found == nullptr) fail_finding(settings, frame_key);
  return *found;
}

void RecordedBench::fail_finding(const CameraSettings& settings, std::uint64_t frame_key) const {
  std::ostringstream text;
  text << camera_name() << ": frame " << frame_key << " asked for with " << settings.exposure_s << " s, "
       << settings.gain_db << " dB, turntable " << sent_[0] << " deg, light azimuth " << sent_[1]
       << " deg, light elevation " << sent_[2] << " deg, lit " << (lamps_.point ? "point light" : "")
       << (lamps_.ring ? "ring flash" : "") << (lamps_.back ? "backlight" : "")
       << (lamps_ == Lighting{} ? "nothing" : "") << ", on the stage " << to_string(placed_)
       << "; the recording has no (more) frame taken so. Ask for shots of the recorded plan only";
  throw OutOfRange(text.str());
}

}  // namespace lumitexel
