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

CameraSettings quantise(const CameraSettings& wanted, const CameraLimits& limits, const std::string& camera_name) {
  // Written so that NaN fails the check as well.
  if (!(wanted.exposure_s >= limits.exposure_min_s && wanted.exposure_s <= limits.exposure_max_s)) {
    std::ostringstream text;
    text << camera_name << ": exposure " << wanted.exposure_s << " s asked for, the camera takes "
         << limits.exposure_min_s << " to " << limits.exposure_max_s << " s";
    throw OutOfRange(text.str());
  }
  CameraSettings settings = wanted;
  if (limits.exposure_step_s > 0.0) {
    // The nearest multiple may lie just outside the limits; 1e-6 of a step forgives rounding in min / step.
    const double step = limits.exposure_step_s;
    const double fewest = std::ceil(limits.exposure_min_s / step - 1e-6);
    const double most = std::floor(limits.exposure_max_s / step + 1e-6);
    const double count = std::max(fewest, std::min(most, std::round(wanted.exposure_s / step)));
    settings.exposure_s = std::clamp(count * step, limits.exposure_min_s, limits.exposure_max_s);
  }
  return settings;
}

CameraSettings Camera::quantised(const CameraSettings& wanted) const { return quantise(wanted, limits(), name()); }

Frame Camera::shoot(const CameraSettings& wanted, std::stop_token stop, std::uint64_t frame_key,
                    int max_attempts) {
  const CameraSettings settings = quantised(wanted);
  CameraSettings last_reported;
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    arm(settings, stop);
    Frame frame = trigger(frame_key, stop);
    frame.frame_key = frame_key;
    if (frame.reported == settings) return frame;
    last_reported = frame.reported;
  }
  std::ostringstream text;
  text << name() << ": asked for exposure " << settings.exposure_s << " s, gain " << settings.gain_db
       << " dB, but " << max_attempts << " frames in a row reported " << last_reported.exposure_s << " s, "
       << last_reported.gain_db << " dB";
  throw Protocol(text.str());
}

}  // namespace lumitexel
