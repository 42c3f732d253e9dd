// Frames of a sensor whose response is a curve, of a scene that spans its range.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "processing/image/fit_response.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {

// From light to code, both in units of the range: rises from 0 at 0 to 1 at 1.
struct CurvedResponse {
  std::string name;
  std::function<double(double)> code, light;  // each other's inverse
};

inline CurvedResponse straight() {
  return {"linear", [](double x) { return x; }, [](double u) { return u; }};
}
inline CurvedResponse gamma_response(double gamma) {
  return {"gamma " + std::to_string(gamma).substr(0, 4),
          [gamma](double x) { return std::pow(std::max(x, 0.0), 1.0 / gamma); },
          [gamma](double u) { return std::pow(std::max(u, 0.0), gamma); }};
}
inline CurvedResponse srgb_response() {
  return {"sRGB", [](double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; },
          [](double u) { return u <= 0.04045 ? u / 12.92 : std::pow((u + 0.055) / 1.055, 2.4); }};
}
// A well that fills more slowly the fuller it is: k of the slope is lost at the end.
inline CurvedResponse compressive(double k) {
  return {"compressive " + std::to_string(k).substr(0, 4),
          [k](double x) { return (1.0 + 0.5 * k) * x / (1.0 + 0.5 * k * x); },
          [k](double u) { return u / (1.0 + 0.5 * k - 0.5 * k * u); }};
}

// A code known only as a function of light, rising: its inverse by bisection.
inline CurvedResponse inverted(std::string name, std::function<double(double)> code) {
  auto light = [code](double u) {
    double low = 0.0, high = 1.0;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (code(middle) < u ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  return {std::move(name), std::move(code), std::move(light)};
}

// Responses on which nothing was tuned. Rec. 709 and ROMM (ProPhoto) RGB: lines, then powers of 0.45 and 1 / 1.8.
inline CurvedResponse rec709_response() {
  return inverted("Rec. 709", [](double x) { return x < 0.018 ? 4.5 * x : 1.099 * std::pow(x, 0.45) - 0.099; });
}
inline CurvedResponse romm_response() {
  return inverted("ROMM", [](double x) { return x < 1.0 / 512.0 ? 16.0 * x : std::pow(x, 1.0 / 1.8); });
}
// Hable's (2010) filmic curve, an S over log light, white at 11.2 of its units.
inline CurvedResponse filmic_response() {
  const auto hable = [](double x) {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
  };
  return inverted("filmic", [hable](double x) { return hable(11.2 * x) / hable(11.2); });
}
// A square root over a pedestal with a soft shoulder, as cameras' own tone curves are.
inline CurvedResponse shouldered_response() {
  const auto toned = [](double x) { return std::tanh(1.2 * (std::sqrt(x + 0.01) - 0.1)); };
  return inverted("shouldered", [toned](double x) { return toned(x) / toned(1.0); });
}
// A sensor of two slopes, the second a quarter, above 30 % of the light.
inline CurvedResponse two_slopes() {
  return inverted("two slopes", [](double x) { return std::min(x, 0.3 + 0.25 * (x - 0.3)) / 0.475; });
}

// sensor: noise in codes; shot noise of electrons_per_dn * (clip - black) electrons at the range's end.
inline std::vector<Frame> curved_bracket(const CurvedResponse& response, const LinearSensor& sensor, int bits,
                                         const std::vector<double>& exposures_s, std::uint64_t seed,
                                         int pixels = 40'000, std::vector<double>* true_rates = nullptr) {
  std::mt19937_64 random(seed);
  const double range_dn = sensor.clip_dn - sensor.black_level_dn, top = std::ldexp(1.0, bits) - 1.0;
  std::uniform_real_distribution<double> decades(-3.5, 0.6);
  std::normal_distribution<double> normal;
  double middle_s = 1.0;
  for (const double exposure_s : exposures_s)
    middle_s *= std::pow(exposure_s, 1.0 / static_cast<double>(exposures_s.size()));
  std::vector<double> rates;
  for (int i = 0; i < pixels; ++i) rates.push_back(std::pow(10.0, decades(random)) / middle_s);
  if (true_rates) *true_rates = rates;  // in units of the range, per second
  std::vector<Frame> frames;
  for (const double exposure_s : exposures_s) {
    Frame frame;
    frame.width_px = pixels / 100;
    frame.height_px = 100;
    frame.bits = bits;
    frame.reported.exposure_s = exposure_s;
    for (const double rate : rates) {
      const double electrons = rate * exposure_s * sensor.electrons_per_dn * range_dn;
      const double light = (electrons + std::sqrt(electrons) * normal(random)) / (sensor.electrons_per_dn * range_dn);
      const double code = sensor.black_level_dn + range_dn * response.code(std::clamp(light, 0.0, 1.0)) +
                          sensor.read_noise_dn * normal(random);
      frame.samples.push_back(static_cast<std::uint16_t>(std::clamp(std::round(code), 0.0, top)));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

inline LinearSensor sensor_of_bits(int bits) {
  const double top = std::ldexp(1.0, bits) - 1.0;
  LinearSensor sensor;
  sensor.black_level_dn = bits == 8 ? 0.0 : top / 64.0;
  sensor.electrons_per_dn = 18000.0 / (top - sensor.black_level_dn);
  sensor.read_noise_dn = bits == 8 ? 0.3 : 4.0 / sensor.electrons_per_dn;
  sensor.clip_dn = top;
  return sensor;
}

// Errors of `linear`, from code in units of the range to light at any scale, all along the usable range.
template <typename Linear>
std::vector<double> relative_errors(const CurvedResponse& truth, const LinearSensor& sensor, const Linear& linear) {
  const double scale = truth.light(0.5) / linear(0.5);
  const double electrons = sensor.electrons_per_dn * (sensor.clip_dn - sensor.black_level_dn);
  const double from = std::max(kUsableFrom, truth.code(kUsableElectrons / electrons));
  std::vector<double> errors;
  for (int i = 0; i <= 400; ++i) {
    const double u = from + (kUsableTo - from) * std::pow(i / 400.0, 2);  // as the knots lie: more of the dim end
    errors.push_back(linear(u) * scale / truth.light(u) - 1.0);
  }
  return errors;
}

// A sensor that got no curve is taken for linear.
inline std::vector<double> response_errors(const ResponseFit& fit, const CurvedResponse& truth,
                                           const LinearSensor& sensor) {
  return relative_errors(truth, sensor, [&](double u) {
    return fit.curve ? fit.curve->linear_dn(sensor.black_level_dn + u * (sensor.clip_dn - sensor.black_level_dn)) : u;
  });
}

}  // namespace lumitexel
