// Dark frames: what the sensor says without light, averaged per exposure time, and which pixels are not to be trusted.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/camera.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {

struct MasterDark {
  CameraSettings settings;
  int width_px = 0, height_px = 0, repetitions = 0;
  std::vector<float> mean_dn;     // black level and dark current, width_px * height_px
  double pixel_variance_dn2 = 0;  // of one sample of a healthy pixel, pooled over all of them: a few repetitions say
                                  // too little about a single one. From the noise model if there is one repetition.
  std::vector<std::uint8_t> hot;  // 1: the pixel's mean lies 10 robust standard deviations from the median
  std::int64_t hot_count = 0;

  // Variance of mean_dn at a pixel: pooled, plus the shot noise of dark current beyond the typical.
  double variance_of_mean_dn2(std::size_t pixel, const LinearSensor& sensor) const;
  double median_dn = 0;
};

// Frames of equal size, bit depth and reported settings, nothing lit. Throws BadInput if there is none or they differ.
MasterDark make_master_dark(const std::vector<Frame>& repetitions, const LinearSensor& sensor);

class DarkLibrary {
 public:
  void add(MasterDark dark) { darks_.push_back(std::move(dark)); }
  // The master dark of exactly these settings and this size. Throws BadInput naming them if there is none: dark
  // current does not scale reliably from another exposure.
  const MasterDark& matching(const CameraSettings& settings, int width_px, int height_px) const;
  const std::vector<MasterDark>& all() const { return darks_; }

 private:
  std::vector<MasterDark> darks_;
};

}  // namespace lumitexel
