// How far a rendering is from a photograph.
//
// Over the object's pixels and all channels, p predicted, q photographed, both linear radiance:
//   relative_rms  sqrt(sum (p - q)^2 / sum q^2)
//   clipped_rms   the same with p and q clipped at the photograph's 99.9th percentile: a few highlight pixels do not
//   decide sqrt_rms      the same of sqrt(max(p, 0)) and sqrt(max(q, 0)): dark parts count as the eye counts them
//   psnr_db       10 log10(peak^2 / mean (p - q)^2), the peak being the photograph's 99.9th percentile
//
// Several views are pooled: the sums run over the pixels of all of them, each photograph keeping its own percentile
// (for PSNR its errors are divided by its own peak).
#pragma once

#include <cstdint>
#include <vector>

#include "processing/image/image.h"

namespace lumitexel {

// NaN where there is nothing to compare; psnr_db is infinite for two equal images.
struct ImageError {
  double relative_rms = 0, clipped_rms = 0, sqrt_rms = 0, psnr_db = 0;
};

class ErrorSums {
 public:
  // `counted` has one entry a pixel, nonzero on the object. The images have the same shape and are finite there.
  void add(const Image& prediction, const Image& photograph, const std::vector<std::uint8_t>& counted);
  void add(const ErrorSums& other);
  ImageError error() const;
  std::int64_t values() const { return values_; }  // pixels times channels

 private:
  struct Ratio {
    double error = 0, photograph = 0;
    void add(double p, double q);
    void add(const Ratio& other);
    double value() const;
  };
  Ratio linear_, clipped_, square_root_;
  double error_over_peak_ = 0;
  std::int64_t values_ = 0;
};

// The value that a share `fraction` of the counted pixels' channel values do not exceed (nearest rank); 0 if none is
// counted.
double percentile(const Image& image, const std::vector<std::uint8_t>& counted, double fraction);

}  // namespace lumitexel
