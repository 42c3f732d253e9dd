// One bracket of a linear sensor merged into radiance, per pixel of the mosaic, before any interpolation.
//
// Every usable sample estimates the rate (raw - dark) / exposure, in DN per second; they are averaged with the inverse
// of their variances. The variance's shot part is taken at the merged estimate, not at the sample itself: a sample that
// happens to be low would claim a low variance and pull the mean down. So a first pass merges by exposure time (total
// counts over total time), and a second one weights with the variances which that estimate predicts.
//
// Samples from LinearSensor::usable_below_dn() on are left out. For a pixel whose expectation lies within a standard
// deviation of that bound this prefers low samples: a bias of at most 0.4 standard deviations of that one exposure.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/image/dark_frames.h"
#include "processing/image/linear_sensor.h"
#include "processing/image/radiance_image.h"

namespace lumitexel {

struct MosaicRadiance {
  int width = 0, height = 0;
  Mosaic mosaic = Mosaic::Mono;
  std::vector<float> value;         // DN per second
  std::vector<float> variance;      // of value
  std::vector<std::uint8_t> flags;  // PixelFlag bits: saturated, dark, defective

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// frames: any order, at least one, equal size and mosaic, each with its master dark in `darks` (found by
// Frame::reported); throws BadInput otherwise. Flags: saturated if no exposure is below the bound (the value is then
// the shortest exposure's, a lower bound); dark if the value is below 3 standard deviations of darkness in the longest
// usable exposure; defective if the pixel is hot in all usable exposures (it is left out of those in which it is hot).
MosaicRadiance merge_bracket(const std::vector<Frame>& frames, const DarkLibrary& darks, const LinearSensor& sensor);

}  // namespace lumitexel
