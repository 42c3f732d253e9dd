#include "processing/image/response/sample_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "processing/image/censored_normal.h"

namespace lumitexel {
namespace {

constexpr double kSmoothElectrons = 400.0;  // from here on a curve is a parabola within the shot noise
constexpr double kCertainSigmas = 5.0;      // a censored sample expected so far above the bound tells nothing

struct ShotNoise {
  double bend, variance;  // of the code
};

// What shot noise makes of the code at `light`, the code of the mean known. A curve that bends within the noise moves
// the mean code away from it: by the second derivative, and below kSmoothElectrons by Gauss and Hermite's rule, for
// curves have kinks.
ShotNoise shot_noise(const ResponseSpline& curve, const UnitSensor& sensor, double light, double code, double slope) {
  const double variance = sensor.shot * std::max(light, 0.0);
  const double spread = variance / (slope * slope);
  if (light > kSmoothElectrons * sensor.shot || light < 0.5 * kDimmestElectrons * sensor.shot)
    return {-0.5 * curve.log_slope_slope(code) * spread, spread};
  double mean = 0.0, square = 0.0;
  for (const auto& [sigmas, weight] : {std::pair{1.35562618, 0.22207592}, {2.85697001, 0.01125741}}) {
    for (const double sign : {-1.0, 1.0}) {
      const double off = curve.inverse(light + sign * sigmas * std::sqrt(variance)) - code;
      mean += weight * off;
      square += weight * off * off;
    }
  }
  return {mean, square - mean * mean};
}

}  // namespace

LinearisedSample linearised(const ResponseSpline& curve, const UnitSensor& sensor, const PixelSample& sample,
                            double rate) {
  const double light = rate * sample.time_s;
  LinearisedSample at;
  at.predicted = curve.inverse(light);
  at.slope = curve.slope(at.predicted);
  at.by_rate = sample.time_s / at.slope;
  const auto [bend, spread] = shot_noise(curve, sensor, light, at.predicted, at.slope);
  const double variance = sensor.reads + spread;
  if (!sample.censored) {
    at.residual = sample.u - at.predicted - bend;
    at.weight = 1.0 / variance;
    at.surprise = at.residual * at.residual / variance + std::log(variance);
    return at;
  }
  const double a = (at.predicted + bend - sensor.usable) / std::sqrt(variance), h = log_cdf_slope(a);
  at.weight = a < kCertainSigmas ? h * (h + a) / variance : 0.0;
  at.residual = std::sqrt(variance) / (h + a);
  at.surprise = -2.0 * log_cdf(a);
  return at;
}

}  // namespace lumitexel
