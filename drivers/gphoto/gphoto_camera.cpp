#include "drivers/gphoto/gphoto_camera.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "drivers/error.h"
#include "drivers/gphoto/camera_raw.h"
#include "drivers/gphoto/exposure_choice.h"
#include "drivers/gphoto/frame_name.h"

namespace lumitexel {
namespace {

constexpr double kWithinASecond_s = 1e-3;

// FNV-1a.
std::uint64_t hash_of(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

std::string extension_of(const std::string& file) {
  const std::size_t dot = file.find_last_of('.');
  std::string extension = dot == std::string::npos ? "raw" : file.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char character) { return static_cast<char>(std::tolower(character)); });
  return extension;
}

std::string listed(const std::vector<std::string>& choices) {
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  return list.empty() ? "none" : list;
}

}  // namespace

GphotoCamera::GphotoCamera(const GphotoConnection& connection, const CameraLimits& limits, std::shared_ptr<Clock> clock,
                           const std::filesystem::path& worker)
    : name_("camera " + (connection.model.empty() ? "" : "'" + connection.model + "' ") + "at " + connection.port),
      connection_(connection),
      limits_(limits),
      clock_(clock),
      remote_(name_, connection, worker, clock) {
  remote_.connect({});
  // Here and not at the first such shot, when the table has moved and a lamp is on.
  for (const double exposure_s : limits_.exposure_choices_s) {
    if (find_choice(remote_.exposure_choices(), parse_exposure_s, exposure_s)) continue;
    std::ostringstream text;
    text << exposure_s << " s, which the " << name_ << " does not have";
    throw BadInput("camera.exposure_choices_s", text.str(), "some of " + listed(remote_.exposure_choices()));
  }
}

void GphotoCamera::recover(std::stop_token stop) { remote_.connect(stop); }

double GphotoCamera::longest_recovery_s() const {
  return connection_.reconnect_timeout_s + 3.0 * connection_.answer_timeout_s;  // set, capture, download
}

double GphotoCamera::iso_of(double gain_db) const { return connection_.iso_at_0_db * std::pow(10.0, gain_db / 20.0); }
double GphotoCamera::gain_db_of(double iso) const { return 20.0 * std::log10(iso / connection_.iso_at_0_db); }

double GphotoCamera::select(const std::string& setting, const std::vector<std::string>& choices,
                            std::optional<double> (*parse)(const std::string&), double wanted, std::stop_token stop) {
  const std::optional<std::string> choice = find_choice(choices, parse, wanted);
  if (!choice) {
    std::ostringstream text;
    text << name_ << ": '" << setting << "' " << wanted << " asked for; its choices are: " << listed(choices);
    throw OutOfRange(text.str());
  }
  const std::string read_back = remote_.set(setting, *choice, stop);
  const std::optional<double> value = parse(read_back);
  if (!value) throw Protocol(name_ + ": '" + setting + "' set to '" + *choice + "', reads back '" + read_back + "'");
  return same_choice(*value, wanted) ? wanted : *value;
}

CameraSettings GphotoCamera::arm(const CameraSettings& settings, std::stop_token stop) {
  if (!remote_.is_connected()) remote_.connect(stop);
  armed_ = settings;
  const double wanted_iso = iso_of(settings.gain_db);
  const double exposure_s =
      select(connection_.exposure_setting, remote_.exposure_choices(), parse_exposure_s, settings.exposure_s, stop);
  const double iso = select(connection_.gain_setting, remote_.gain_choices(), parse_iso, wanted_iso, stop);
  return {exposure_s, iso == wanted_iso ? settings.gain_db : gain_db_of(iso)};
}

Frame GphotoCamera::trigger(std::uint64_t frame_key, std::stop_token stop) {
  if (!connection_.frame_name_setting.empty()) {
    const std::string asked = frame_name(frame_key);
    const std::string read_back = remote_.set(connection_.frame_name_setting, asked, stop);
    if (frame_key_of(read_back) != frame_key) {
      throw Protocol(name_ + ": '" + connection_.frame_name_setting + "' set to '" + asked + "', reads back '" +
                     read_back + "'");
    }
  }
  DownloadedPicture picture = remote_.take_picture(armed_.exposure_s, stop);
  CameraRaw raw = decoded(picture);
  Frame frame;
  frame.width_px = raw.width_px;
  frame.height_px = raw.height_px;
  frame.bits = raw.bits;
  frame.mosaic = raw.mosaic;
  frame.reported = reported_by(raw, picture.file);
  frame.device_time_s = last_time_s_ = time_of(raw);
  frame.sensor_temperature_c = raw.exif.temperature_c.value_or(0.0);
  frame.device_frame_id = raw.exif.image_number ? *raw.exif.image_number : hash_of(picture.bytes);
  frame.echoed_key = key_in(raw, picture.file);
  frame.samples = std::move(raw.samples);
  frame.camera_file = std::move(picture.bytes);
  frame.camera_file_extension = extension_of(picture.file);
  return frame;
}

CameraRaw GphotoCamera::decoded(const DownloadedPicture& picture) const {
  try {
    return decode_camera_raw(picture.bytes, name_ + ": " + picture.file);
  } catch (const Corrupt& error) {
    throw Protocol(error.what());  // as it came from the camera, it was never stored: it can be taken once more
  }
}

CameraSettings GphotoCamera::reported_by(const CameraRaw& raw, const std::string& file) const {
  if (!raw.exif.exposure_s || !raw.exif.iso) {
    throw Protocol(name_ + ": " + file + ": its EXIF says no " + (raw.exif.exposure_s ? "ISO value" : "exposure time"));
  }
  CameraSettings reported{*raw.exif.exposure_s, gain_db_of(*raw.exif.iso)};
  if (same_choice(reported.exposure_s, armed_.exposure_s)) reported.exposure_s = armed_.exposure_s;
  if (same_choice(*raw.exif.iso, iso_of(armed_.gain_db))) reported.gain_db = armed_.gain_db;
  return reported;
}

std::optional<std::uint64_t> GphotoCamera::key_in(const CameraRaw& raw, const std::string& file) const {
  if (connection_.frame_name_setting.empty()) return {};
  for (const std::string& text : {raw.exif.artist, raw.exif.copyright}) {
    if (const auto key = frame_key_of(text)) return key;
  }
  throw Protocol(name_ + ": " + file + ": neither EXIF's artist '" + raw.exif.artist + "' nor its copyright '" +
                 raw.exif.copyright + "' is the name that was set by '" + connection_.frame_name_setting + "'");
}

double GphotoCamera::time_of(const CameraRaw& raw) {
  if (!raw.exif.time_s) return clock_->now_s();
  // Whole seconds, or hundredths that are always 00. An older picture's time is its own: it has to be refused.
  const bool stands = std::floor(last_time_s_) == std::floor(*raw.exif.time_s) && *raw.exif.time_s <= last_time_s_;
  const bool whole = *raw.exif.time_s == std::floor(*raw.exif.time_s);
  return stands && whole ? last_time_s_ + kWithinASecond_s : *raw.exif.time_s;
}

}  // namespace lumitexel
