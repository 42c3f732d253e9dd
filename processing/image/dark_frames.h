// Dark frames: what the sensor says without light, averaged per exposure time, and which pixels are not to be trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/camera.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {

// Dark current doubles every 5 to 8 K: within this window it changes by at most 15 %, which is 4 % of the distance to
// the threshold of a hot pixel.
inline constexpr double kDarkTemperatureWindow_k = 1.5;

// Frame::sensor_temperature_c as a number, if the camera told one: drivers leave exactly 0 where it does not.
std::optional<double> known_temperature_c(const Frame& frame);

struct MasterDark {
  CameraSettings settings;
  int width_px = 0, height_px = 0, bits = 16, repetitions = 0;
  Mosaic mosaic = Mosaic::Mono;
  std::optional<double> temperature_c;  // mean over the repetitions; empty unless all of them know theirs
  std::vector<float> mean_dn;     // black level and dark current, width_px * height_px
  double pixel_variance_dn2 = 0;  // of one sample of a healthy pixel, pooled over all of them: a few repetitions say
                                  // too little about a single one. From the noise model if there is one repetition.
  std::vector<std::uint8_t> hot;  // 1: the pixel's mean lies 10 robust standard deviations from the median
  std::int64_t hot_count = 0;
  double median_dn = 0;
  // Where the dark current was scaled (scaled_dark): by how much, and the factor's standard deviation.
  double scale = 1.0, scale_sigma = 0.0;

  // Variance of mean_dn at a pixel: pooled, plus the shot noise of dark current beyond the typical, plus the scale's.
  double variance_of_mean_dn2(std::size_t pixel, const LinearSensor& sensor) const;
};

// Frames of equal size, bit depth, mosaic and reported settings, nothing lit, their temperatures (where known) within
// kDarkTemperatureWindow_k of their mean. Throws BadInput if there is none or they differ.
MasterDark make_master_dark(const std::vector<Frame>& repetitions, const LinearSensor& sensor);

// Repetitions of one exposure in groups whose temperatures fit into one master dark: darks taken before and after a
// session are two. Those of unknown temperature are a group of their own.
std::vector<std::vector<Frame>> grouped_by_temperature(std::vector<Frame> repetitions);

struct DarkMatch {
  const MasterDark* dark = nullptr;  // owned by the library
  enum class Temperature { Same, Unknown, Drifted } temperature = Temperature::Same;  // Drifted: outside the window
};

class DarkLibrary {
 public:
  void add(MasterDark dark) { darks_.push_back(std::move(dark)); }
  // The master dark of exactly this frame's size, bits, mosaic, exposure and gain: never the nearest exposure. Of several
  // the one nearest in temperature. Throws BadInput naming them if there is none.
  DarkMatch matching(const Frame& frame) const;
  const std::vector<MasterDark>& all() const { return darks_; }

 private:
  std::vector<MasterDark> darks_;
};

}  // namespace lumitexel
