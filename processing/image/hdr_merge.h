// One bracket merged into radiance, per pixel of the mosaic, before any interpolation.
//
// Every usable sample estimates the rate (raw - dark) / exposure, in DN per second; they are averaged with the inverse
// of their variances. The variance's shot part is taken at the merged estimate, not at the sample itself: a sample that
// happens to be low would claim a low variance and pull the mean down. So a first pass merges by exposure time (total
// counts over total time), and a second one weights with the variances which that estimate predicts.
//
// Samples from LinearSensor::usable_below_dn() on are censored: they say "at least so much". Leaving them out would
// prefer low samples where an exposure's expectation lies near the bound, so there (and only there) their probability
// joins the likelihood, Tobin's model. The error is within 1.05 of the bracket's Cramer-Rao bound (tests/bench/hdr_bound)
// but for some 1.5 % of radiance about each exposure's limit: exposures at ratios of 8, up to 1.7 there, less than 1 just
// above, 0.99 over both; 1.3 at ratios of 4 and 1.1 at 2. No estimator can do better than 1.048, 1.002 and 0.99 there at
// every radiance (tests/bench/saturation_limit), and that one is biased by a third to half of the bound wherever an
// exposure is within ten of its standard deviations of its limit; this one only within two and a half.
// In the shortest exposure nothing tells a pixel that came out low from a dimmer one; unflagged pixels at its very
// limit are low by up to 0.8 standard deviations, which their variance covers: as a mean square error it is right.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/image/dark_frames.h"
#include "processing/image/dark_scale.h"
#include "processing/image/linear_sensor.h"
#include "processing/image/radiance_image.h"
#include "processing/image/response_curve.h"

namespace lumitexel {

struct MosaicRadiance {
  int width = 0, height = 0;
  Mosaic mosaic = Mosaic::Mono;
  std::vector<float> value;         // DN per second
  std::vector<float> variance;      // of value
  std::vector<std::uint8_t> flags;  // PixelFlag bits: saturated, dark, defective
  // The temperature of at least one frame was outside its dark's window, and the frames could not tell the scale.
  bool darks_drifted = false;
  DarkScale dark_scale;  // fitted where a temperature was outside the window or unknown; applied if `needed`

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// frames: any order, at least one, of equal size, bits, mosaic and gain, exposures positive, each with its master dark in
// `darks`; throws BadInput otherwise. sensor: at that gain. response: null for a linear sensor; else its linear values
// are what is merged, noise multiplied by its slope.
// Flags: saturated if no exposure is below the bound (the value is then the shortest exposure's, a lower bound); dark if
// the value is below 3 standard deviations of darkness in the longest usable exposure, or all its samples are 0;
// defective if the pixel is hot in all usable exposures (it is left out of those in which it is hot).
MosaicRadiance merge_bracket(const std::vector<Frame>& frames, const DarkLibrary& darks, const LinearSensor& sensor,
                             const ResponseCurve* response = nullptr);

}  // namespace lumitexel
