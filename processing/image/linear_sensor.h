// The noise of a linear sensor, in its own numbers (DN): photon and dark-current shot noise, read noise, rounding.
#pragma once

#include "drivers/camera.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct LinearSensor {
  double electrons_per_dn = 1.0;  // at the gain in use
  double read_noise_dn = 0.0;
  double black_level_dn = 0.0;
  double clip_dn = 65535.0;      // the mean of saturated samples: the well's or the converter's end
  double clip_spread_dn = 0.0;   // how saturated samples scatter beyond read noise: wells differ from pixel to pixel

  // Variance of one raw sample whose expectation lies signal_dn above the black level (light and dark current alike).
  double variance_dn2(double signal_dn) const;
  // Samples from here on may be saturated ones: 6.5 standard deviations of those below clip_dn. Shot noise does not
  // count among them, for a full well has none.
  double usable_below_dn() const;
};

// electrons_per_dn holds at 0 dB; gain is a voltage ratio (20 dB: ten times).
LinearSensor linear_sensor(const CameraDescription& camera, double gain_db);
// Throws BadInput naming the field unless the noise model is finite, gains positive, and clipping above the black level.
void check_sensor(const LinearSensor& sensor);

// Which of the colours R, G, B (0, 1, 2) a pixel of the mosaic sees; always 0 for a mono sensor.
int mosaic_channel(Mosaic mosaic, int x, int y);
inline int mosaic_channels(Mosaic mosaic) { return mosaic == Mosaic::Mono ? 1 : 3; }

}  // namespace lumitexel
