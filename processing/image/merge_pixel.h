// The estimate of one pixel from the exposures of a bracket: the arithmetic inside merge_bracket (hdr_merge.h says which).
#pragma once

#include <cstdint>
#include <vector>

#include "processing/image/dark_frames.h"
#include "processing/image/linear_sensor.h"
#include "processing/image/response_curve.h"

namespace lumitexel {

struct BracketExposure {
  const std::uint16_t* samples = nullptr;
  const MasterDark* dark = nullptr;
  double time_s = 0;
};

struct PixelEstimate {
  double rate = 0, variance = 0;  // DN per second
  std::uint8_t flags = 0;         // PixelFlag bits
};

class PixelMerger {
 public:
  // ascending: by time, at least one; what they point at, and the response, must outlive this.
  PixelMerger(std::vector<BracketExposure> ascending, int bits, const LinearSensor& sensor,
              const ResponseCurve* response);
  PixelEstimate merge(std::size_t pixel) const { return response_ ? merge_as<true>(pixel) : merge_as<false>(pixel); }

 private:
  struct Noise {
    double fixed_dn2;         // read noise, rounding, the dark's pooled variance
    double excess_weight;     // shot noise of a hot pixel in the dark's mean, per DN of excess
    double seconds;
  };
  template <bool kCurved> PixelEstimate merge_as(std::size_t pixel) const;
  template <bool kCurved> double linear(double code) const;
  template <bool kCurved> double signal(std::size_t exposure, std::size_t pixel) const;
  template <bool kCurved> double variance(std::size_t exposure, std::size_t pixel, double signal_dn) const;
  template <bool kCurved> void add_censored(std::size_t first, std::size_t pixel, double weight, PixelEstimate& estimate) const;
  template <bool kCurved> PixelEstimate unusable(std::size_t pixel) const;

  std::vector<BracketExposure> exposures_;
  std::vector<Noise> noise_;
  LinearSensor sensor_;
  const ResponseCurve* response_;
  std::vector<double> table_;  // linear value of every code
  double per_electron_;        // 1 / electrons_per_dn
  std::uint32_t bound_;        // the least censored code
  double bound_linear_;        // the linear value at its lower edge
};

}  // namespace lumitexel
