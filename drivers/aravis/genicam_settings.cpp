#include "drivers/aravis/genicam_settings.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kMicroseconds = 1e6;
constexpr double kRounding = 1e-6;  // relative: of limits written in decimals

template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void require_exposures(const AravisDevice& device, const CameraLimits& limits) {
  double min_us = 0, max_us = 0;
  device.call("bounds of ExposureTime", arv_camera_get_exposure_time_bounds, &min_us, &max_us);
  const double min_s = min_us / kMicroseconds, max_s = max_us / kMicroseconds;
  if (!(limits.exposure_min_s >= min_s * (1 - kRounding))) {
    throw OutOfRange(text_of(device.name(), ": exposure_min_s = ", limits.exposure_min_s,
                             " in the rig's description, the camera takes ", min_s, " s and more"));
  }
  if (!(limits.exposure_max_s <= max_s * (1 + kRounding))) {
    throw OutOfRange(text_of(device.name(), ": exposure_max_s = ", limits.exposure_max_s,
                             " in the rig's description, the camera takes at most ", max_s, " s"));
  }
}

void require_gains(const AravisDevice& device, const CameraLimits& limits) {
  double min_db = 0, max_db = 0;
  device.call("bounds of Gain", arv_camera_get_gain_bounds, &min_db, &max_db);
  const double slack_db = 1e-4;
  if (std::isfinite(limits.gain_min_db) && limits.gain_min_db < min_db - slack_db) {
    throw OutOfRange(text_of(device.name(), ": gain_min_db = ", limits.gain_min_db,
                             " in the rig's description, the camera takes ", min_db, " dB and more"));
  }
  if (std::isfinite(limits.gain_max_db) && limits.gain_max_db > max_db + slack_db) {
    throw OutOfRange(text_of(device.name(), ": gain_max_db = ", limits.gain_max_db,
                             " in the rig's description, the camera takes at most ", max_db, " dB"));
  }
}

void require_sensor(const AravisDevice& device, const AravisConnection& connection, const CameraLimits& limits) {
  gint width_px = 0, height_px = 0;
  device.call("the sensor's size", arv_camera_get_sensor_size, &width_px, &height_px);
  if (connection.region_x_px + limits.width_px > width_px || connection.region_y_px + limits.height_px > height_px) {
    throw BadInput(device.name() + ": width_px, height_px, region_x_px, region_y_px",
                   text_of(limits.width_px, " x ", limits.height_px, " at ", connection.region_x_px, ", ",
                           connection.region_y_px),
                   text_of("a region inside the sensor's ", width_px, " x ", height_px, " pixels"));
  }
}

void set_region(const AravisDevice& device, const AravisConnection& connection, const CameraLimits& limits) {
  const std::string region = text_of(limits.width_px, " x ", limits.height_px, " pixels at ", connection.region_x_px,
                                     ", ", connection.region_y_px);
  device.call("setting the region to " + region, arv_camera_set_region, connection.region_x_px, connection.region_y_px,
              limits.width_px, limits.height_px);
  gint x = 0, y = 0, width = 0, height = 0;
  device.call("reading the region", arv_camera_get_region, &x, &y, &width, &height);
  if (x != connection.region_x_px || y != connection.region_y_px || width != limits.width_px ||
      height != limits.height_px) {
    throw Protocol(device.name() + ": set the region to " + region + ", it reads back " +
                   text_of(width, " x ", height, " at ", x, ", ", y));
  }
}

PixelLayout set_pixel_format(const AravisDevice& device, const AravisConnection& connection,
                             const CameraLimits& limits) {
  const std::vector<std::string> offered = device.choices("PixelFormat");
  const std::string key = device.name() + ": pixel_format";
  std::string known;
  for (const std::string& name : offered) known += (known.empty() ? "" : ", ") + name;
  std::optional<PixelLayout> layout;
  if (connection.pixel_format.empty()) {
    layout = suitable_layout(limits.mosaic, limits.bits, offered);
    if (!layout) {
      throw BadInput(key, "none of the camera's (" + known + ")",
                     text_of("one for ", limits.bits, " bits, ", to_string(limits.mosaic)));
    }
  } else {
    layout = pixel_layout(connection.pixel_format);
    if (!layout || !contains(offered, connection.pixel_format)) {
      throw BadInput(key, "'" + connection.pixel_format + "'", "one that the camera has: " + known);
    }
    if (layout->mosaic != limits.mosaic || layout->bits < limits.bits) {
      throw BadInput(key, "'" + connection.pixel_format + "'",
                     text_of("one for the rig's ", limits.bits, " bits, ", to_string(limits.mosaic)));
    }
  }
  device.set_verified("PixelFormat", layout->name);
  return *layout;
}

void set_trigger(const AravisDevice& device) {
  device.call("setting AcquisitionMode to Continuous", arv_camera_set_acquisition_mode, ARV_ACQUISITION_MODE_CONTINUOUS);
  device.call("setting the trigger to Software", arv_camera_set_trigger, "Software");
  for (const auto& [feature, expected] : {std::pair{"TriggerMode", "On"}, std::pair{"TriggerSource", "Software"}}) {
    const std::string now = device.text(feature);
    if (now != expected) throw Protocol(device.name() + ": set " + feature + " to " + expected + ", it reads " + now);
  }
}

// A camera that chooses its settings itself cannot be armed.
void switch_automatics_off(const AravisDevice& device) {
  for (const char* feature : {"ExposureAuto", "GainAuto", "BalanceWhiteAuto", "BlackLevelAuto"}) {
    if (device.has(feature)) device.set_verified(feature, "Off");
  }
}

void enable_chunk(const AravisDevice& device, const std::string& chunk) {
  device.call("enabling the chunk " + chunk, arv_camera_set_chunk_state, chunk.c_str(), TRUE);
  if (!device.call("reading the state of chunk " + chunk, arv_camera_get_chunk_state, chunk.c_str())) {
    throw Protocol(device.name() + ": enabled the chunk " + chunk + ", it reads back disabled");
  }
}

// ChunkSelector knows chunks without the "Chunk" that their values' names begin with.
std::string selector_of(const std::string& chunk) { return chunk.starts_with("Chunk") ? chunk.substr(5) : chunk; }

void set_chunks(const AravisDevice& device, const AravisConnection& connection, CameraSetup& setup) {
  const std::string& wanted = connection.frame_name_chunk;
  const std::string key = device.name() + ": frame_name_chunk";
  const bool available = device.has("ChunkModeActive") && device.has("ChunkSelector");
  if (!available) {
    if (!wanted.empty()) throw BadInput(key, "'" + wanted + "'", "nothing: this camera has no chunks");
    return;
  }
  const std::vector<std::string> offered = device.choices("ChunkSelector");
  setup.exposure_chunk = contains(offered, "ExposureTime");
  setup.gain_chunk = contains(offered, "Gain");
  setup.name_chunk = !wanted.empty();
  if (setup.name_chunk && !contains(offered, selector_of(wanted))) {
    throw BadInput(key, "'" + wanted + "'", "a chunk that this camera has");
  }
  device.call("switching chunks on", arv_camera_set_chunk_mode, setup.any_chunk() ? TRUE : FALSE);
  for (const std::string& chunk : offered) {
    const bool used = (setup.exposure_chunk && chunk == "ExposureTime") || (setup.gain_chunk && chunk == "Gain") ||
                      (setup.name_chunk && chunk == selector_of(wanted));
    if (used) enable_chunk(device, chunk);
  }
}

void find_clock(const AravisDevice& device, CameraSetup& setup) {
  if (device.has("GevTimestampControlLatch") && device.has("GevTimestampValue")) {
    setup.latch = CameraSetup::Latch::Ticks;
    GErrorSlot error;
    const auto ticks = arv_gv_device_get_timestamp_tick_frequency(
        ARV_GV_DEVICE(arv_camera_get_device(device.camera())), error);
    error.require(device.name(), "reading the timestamp's frequency");
    if (ticks == 0) setup.latch = CameraSetup::Latch::None;
    setup.ticks_per_s = static_cast<double>(ticks);
  } else if (device.has("TimestampLatch") && device.has("TimestampLatchValue")) {
    setup.latch = CameraSetup::Latch::Nanoseconds;
  }
}

void set_packet_size(const AravisDevice& device, int bytes) {
  if (!device.is_gige()) return;
  arv_camera_gv_set_packet_size_adjustment(device.camera(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  // Twice before the rig's file is blamed: a camera that rebooted between writing and reading has forgotten the size, and
  // us, which the second write finds out.
  int now = 0;
  for (int attempt = 0; attempt < 2; ++attempt) {
    device.call("setting the packet size to " + std::to_string(bytes), arv_camera_gv_set_packet_size, bytes);
    now = static_cast<int>(device.call("reading the packet size", arv_camera_gv_get_packet_size));
    if (now == bytes) return;
  }
  throw BadInput(device.name() + ": packet_size_bytes", std::to_string(bytes),
                 "a size that the camera keeps; it reads back " + std::to_string(now));
}

}  // namespace

CameraSetup set_up(const AravisDevice& device, const AravisConnection& connection, const CameraLimits& limits) {
  device.call("stopping acquisition", arv_camera_stop_acquisition);
  CameraSetup setup;
  require_sensor(device, connection, limits);
  require_exposures(device, limits);
  setup.gain = device.call("has it a gain", arv_camera_is_gain_available);
  if (setup.gain) require_gains(device, limits);
  if (!connection.frame_name_feature.empty() && !device.has(connection.frame_name_feature)) {
    throw BadInput(device.name() + ": frame_name_feature", "'" + connection.frame_name_feature + "'",
                   "a feature that this camera has");
  }
  setup.layout = set_pixel_format(device, connection, limits);
  set_region(device, connection, limits);
  set_packet_size(device, connection.packet_size_bytes);
  switch_automatics_off(device);
  set_trigger(device);
  set_chunks(device, connection, setup);
  find_clock(device, setup);
  setup.temperature = !connection.temperature_feature.empty() && device.has(connection.temperature_feature);
  setup.payload_bytes = device.call("reading PayloadSize", arv_camera_get_payload);
  const std::size_t image_bytes =
      setup.layout.bytes(static_cast<std::size_t>(limits.width_px) * static_cast<std::size_t>(limits.height_px));
  if (setup.payload_bytes < image_bytes) {
    throw Protocol(text_of(device.name(), ": asked for frames of ", image_bytes, " bytes, PayloadSize reads ",
                           setup.payload_bytes));
  }
  return setup;
}

void apply_settings(const AravisDevice& device, const CameraSetup& setup, const CameraSettings& settings) {
  const double exposure_us = settings.exposure_s * kMicroseconds;
  device.call(text_of("setting ExposureTime to ", exposure_us, " us"), arv_camera_set_exposure_time, exposure_us);
  if (setup.gain) {
    device.call(text_of("setting Gain to ", settings.gain_db, " dB"), arv_camera_set_gain, settings.gain_db);
  } else if (settings.gain_db != 0.0) {
    throw OutOfRange(text_of(device.name(), ": gain ", settings.gain_db, " dB asked for, the camera has none"));
  }
}

CameraSettings read_settings(const AravisDevice& device, const CameraSetup& setup) {
  CameraSettings settings;
  settings.exposure_s = device.call("reading ExposureTime", arv_camera_get_exposure_time) / kMicroseconds;
  settings.gain_db = setup.gain ? device.call("reading Gain", arv_camera_get_gain) : 0.0;
  return settings;
}

std::uint64_t latched_time_ns(const AravisDevice& device, const CameraSetup& setup) {
  if (setup.latch == CameraSetup::Latch::Nanoseconds) {
    device.execute("TimestampLatch");
    return static_cast<std::uint64_t>(device.integer("TimestampLatchValue"));
  }
  device.execute("GevTimestampControlLatch");
  const auto ticks = static_cast<long double>(device.integer("GevTimestampValue"));
  return static_cast<std::uint64_t>(ticks * 1e9L / setup.ticks_per_s);
}

}  // namespace lumitexel
