// How a sample of a bent sensor scatters about what a curve and a rate predict.
#pragma once

#include "processing/image/response/bracket_pixels.h"
#include "processing/image/response/response_spline.h"

namespace lumitexel {

// A sample about the curve's prediction, for least squares: u = predicted + bend + by_rate * (change of the rate).
// slope: dL/du at `predicted`. Of a censored sample weight and residual give its log likelihood's slope and curvature.
// surprise: -2 log likelihood, up to a constant.
struct LinearisedSample {
  double residual, weight, by_rate, predicted, slope, surprise;
};

LinearisedSample linearised(const ResponseSpline& curve, const UnitSensor& sensor, const PixelSample& sample,
                            double rate);

// In electrons: below, more than the second derivative bends the mean code, and a sample does not count.
inline constexpr double kDimmestElectrons = 12.0;

}  // namespace lumitexel
