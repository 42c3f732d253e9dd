// What the fit of a response looks at: pixels of brackets, their samples in units of the sensor's range over black.
#pragma once

#include <vector>

#include "drivers/camera.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {

// The sensor's noise in units of its range, clip - black.
struct UnitSensor {
  double range_dn, usable, shot, reads;  // usable: the lower edge of the least censored code; shot, reads: variances
  explicit UnitSensor(const LinearSensor& sensor);
};

struct PixelSample {
  double u, time_s;  // code in units of the range
  bool censored;     // not below `usable`: only that is known
  bool counts;
};

struct BracketPixel {
  std::vector<PixelSample> samples;
  double rate;        // linear value in units of the range, per second
  bool tells = true;  // enough, of the curve
};

// Pixels of every brightness alike, so that the curve is known everywhere: a scene is mostly dark. `rate` is that of a
// linear sensor. Throws BadInput for a bracket whose frames differ in size or whose times are not two positive ones.
std::vector<BracketPixel> chosen_pixels(const std::vector<std::vector<Frame>>& brackets, const LinearSensor& sensor);

}  // namespace lumitexel
