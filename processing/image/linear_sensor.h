// The noise of a linear sensor, in its own numbers (DN): photon and dark-current shot noise, read noise, rounding.
#pragma once

#include "drivers/camera.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct LinearSensor {
  double electrons_per_dn = 1.0;  // at the gain in use
  double read_noise_dn = 0.0;
  double black_level_dn = 0.0;
  double clip_dn = 65535.0;  // the least value at which the well or the converter saturates

  // Variance of one raw sample whose expectation lies signal_dn above the black level (light and dark current alike).
  double variance_dn2(double signal_dn) const;
  // Raw values from here on may have been clipped: four standard deviations below clip_dn.
  double usable_below_dn() const;
};

// electrons_per_dn holds at 0 dB; gain is a voltage ratio (20 dB: ten times).
LinearSensor linear_sensor(const CameraDescription& camera, double gain_db);

// Which of the colours R, G, B (0, 1, 2) a pixel of the mosaic sees; always 0 for a mono sensor.
int mosaic_channel(Mosaic mosaic, int x, int y);
inline int mosaic_channels(Mosaic mosaic) { return mosaic == Mosaic::Mono ? 1 : 3; }

}  // namespace lumitexel
