#include "drivers/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::array<std::pair<Mosaic, const char*>, 5> kMosaicNames{{{Mosaic::Mono, "mono"},
                                                                      {Mosaic::Rggb, "rggb"},
                                                                      {Mosaic::Bggr, "bggr"},
                                                                      {Mosaic::Grbg, "grbg"},
                                                                      {Mosaic::Gbrg, "gbrg"}}};

}  // namespace

const char* to_string(Mosaic mosaic) {
  for (const auto& [value, name] : kMosaicNames) {
    if (value == mosaic) return name;
  }
  return "unknown";
}

Mosaic mosaic_from_string(const std::string& name) {
  for (const auto& [value, known] : kMosaicNames) {
    if (name == known) return value;
  }
  throw BadInput("mosaic", "'" + name + "'", "mono, rggb, bggr, grbg or gbrg");
}

namespace {

constexpr double kSameExposure = 1e-6;  // relative: microseconds in a float, a step written in decimals
constexpr double kSameGain_db = 1e-4;

std::string text_of(const CameraSettings& settings) {
  std::ostringstream text;
  text << settings.exposure_s << " s, " << settings.gain_db << " dB";
  return text.str();
}

// Written so that NaN fails the check as well.
void require_within(double value, double min, double max, const char* what, const char* unit,
                    const std::string& camera_name) {
  if (value >= min && value <= max) return;
  std::ostringstream text;
  text << camera_name << ": " << what << ' ' << value << ' ' << unit << " asked for, the camera takes " << min << " to "
       << max << ' ' << unit;
  throw OutOfRange(text.str());
}

// The nearest multiple may lie just outside the limits; 1e-6 of a step forgives rounding in min / step.
double nearest_multiple(double value, double step, double min, double max) {
  const double fewest = std::ceil(min / step - 1e-6), most = std::floor(max / step + 1e-6);
  const double count = std::max(fewest, std::min(most, std::round(value / step)));
  return std::clamp(count * step, min, max);
}

// Nearest in stops: choices are spaced by ratios.
double nearest_choice(double value, const std::vector<double>& choices) {
  return *std::min_element(choices.begin(), choices.end(), [value](double a, double b) {
    return std::abs(std::log(a / value)) < std::abs(std::log(b / value));
  });
}

bool worth_another_attempt(const Error& error) {
  return dynamic_cast<const Timeout*>(&error) || dynamic_cast<const Disconnected*>(&error) ||
         dynamic_cast<const Protocol*>(&error);
}

}  // namespace

CameraSettings quantise(const CameraSettings& wanted, const CameraLimits& limits, const std::string& camera_name) {
  require_within(wanted.exposure_s, limits.exposure_min_s, limits.exposure_max_s, "exposure", "s", camera_name);
  require_within(wanted.gain_db, limits.gain_min_db, limits.gain_max_db, "gain", "dB", camera_name);
  CameraSettings settings = wanted;
  if (!limits.exposure_choices_s.empty()) {
    settings.exposure_s = nearest_choice(wanted.exposure_s, limits.exposure_choices_s);
  } else if (limits.exposure_step_s > 0.0) {
    settings.exposure_s =
        nearest_multiple(wanted.exposure_s, limits.exposure_step_s, limits.exposure_min_s, limits.exposure_max_s);
  }
  if (limits.gain_step_db > 0.0) {
    settings.gain_db = nearest_multiple(wanted.gain_db, limits.gain_step_db, limits.gain_min_db, limits.gain_max_db);
  }
  return settings;
}

bool same_settings(const CameraSettings& a, const CameraSettings& b) {
  return std::abs(a.exposure_s - b.exposure_s) <= kSameExposure * std::abs(b.exposure_s) &&
         std::abs(a.gain_db - b.gain_db) <= kSameGain_db;
}

CameraSettings Camera::quantised(const CameraSettings& wanted) const { return quantise(wanted, limits(), name()); }

double Camera::longest_shot_s(const CameraSettings& settings, int max_attempts) const {
  const CameraLimits limit = limits();
  const double attempt_s = (1 + limit.settings_latency_frames) * (settings.exposure_s + limit.readout_s);
  return max_attempts * (attempt_s + longest_recovery_s());
}

void Camera::recover(std::stop_token) {}

void Camera::discard(std::uint64_t key, const CameraSettings& asked, std::optional<CameraSettings> reported,
                     const std::string& cause) const {
  if (discard_listener_) discard_listener_({key, asked, reported, cause});
}

// Why the frame cannot be accepted; empty if it can.
std::string Camera::objection(const Frame& frame, const CameraSettings& settings, std::uint64_t frame_key) const {
  const CameraLimits limit = limits();
  std::ostringstream text;
  const std::size_t pixels = static_cast<std::size_t>(limit.width_px) * static_cast<std::size_t>(limit.height_px);
  if (frame.width_px != limit.width_px || frame.height_px != limit.height_px || frame.bits != limit.bits ||
      frame.mosaic != limit.mosaic || frame.samples.size() != pixels) {
    text << "a frame of " << frame.width_px << " x " << frame.height_px << " pixels, " << frame.bits << " bits, "
         << to_string(frame.mosaic) << ", " << frame.samples.size() << " samples came from a camera of "
         << limit.width_px << " x " << limit.height_px << ", " << limit.bits << " bits, " << to_string(limit.mosaic);
  } else if (!same_settings(frame.reported, settings)) {
    text << "asked for " << text_of(settings) << ", the frame reports " << text_of(frame.reported);
  } else if (frame.echoed_key && *frame.echoed_key != frame_key) {
    text << "asked for frame " << frame_key << ", got the frame named " << *frame.echoed_key;
  } else if (last_frame_id_ && *last_frame_id_ == frame.device_frame_id) {
    text << "frame " << frame.device_frame_id << " of the camera's count was delivered before";
  } else if (!(frame.device_time_s > last_device_time_s_)) {
    text << "the frame is of " << frame.device_time_s << " s on the camera's clock, the one before it of "
         << last_device_time_s_ << " s";
  }
  return text.str();
}

Frame Camera::attempt(const CameraSettings& settings, std::uint64_t frame_key, std::stop_token stop) {
  const CameraSettings applied = arm(settings, stop);
  if (!same_settings(applied, settings)) {
    throw Protocol(name() + ": asked for " + text_of(settings) + ", reads back " + text_of(applied));
  }
  if (last_settings_ != settings) {
    // Whatever comes here is not looked at, but that it comes is waited for.
    for (int i = 0; i < limits().settings_latency_frames; ++i) trigger(frame_key, stop);
  }
  return trigger(frame_key, stop);
}

Frame Camera::shoot(const CameraSettings& wanted, std::stop_token stop, std::uint64_t frame_key, int max_attempts) {
  const CameraSettings settings = quantised(wanted);
  for (int left = std::max(1, max_attempts) - 1;; --left) {
    std::string cause;
    try {
      // A frame that a failed or cancelled attempt has triggered may still be on its way: it must not meet the next one.
      if (needs_recovery_) recover(stop);
      needs_recovery_ = true;
      Frame frame = attempt(settings, frame_key, stop);
      needs_recovery_ = false;
      cause = objection(frame, settings, frame_key);
      if (cause.empty()) return accepted(std::move(frame), settings, frame_key);
      discard(frame_key, settings, frame.reported, cause);
    } catch (const Error& error) {
      // A reconnected camera may keep time anew. Its count may start again, too: if that makes a good frame look like
      // the last one, it is shot once more, and no harm is done.
      last_settings_.reset();
      last_device_time_s_ = -std::numeric_limits<double>::infinity();
      if (!worth_another_attempt(error)) throw;
      discard(frame_key, settings, {}, error.what());
      if (left <= 0) throw;
      continue;
    }
    if (left <= 0) throw Protocol(name() + ": " + cause + "; " + std::to_string(max_attempts) + " attempts");
  }
}

Frame Camera::accepted(Frame frame, const CameraSettings& settings, std::uint64_t frame_key) {
  last_settings_ = settings;
  last_frame_id_ = frame.device_frame_id;
  last_device_time_s_ = frame.device_time_s;
  frame.frame_key = frame_key;
  return frame;
}

}  // namespace lumitexel
