// How far a model's pictures are from given ones, with what belongs to the absolute scale told from the rest.
#pragma once

#include "processing/evaluation/image_error.h"

namespace lumitexel {

// Over the counted pixels' channels of all pictures, p predicted and q given, for `clipped` and `level` both clipped at q's 99.9th
// percentile:
struct RelightingError {
  double clipped = 0, roots = 0;  // ImageError's clipped_rms and sqrt_rms
  double level = 0;               // sum p / sum q - 1: 0.01 for pictures that are 1 % too bright
};

class RelightingSums {
 public:
  // As ErrorSums::add.
  void add(const Image& prediction, const Image& given, const std::vector<std::uint8_t>& counted);
  RelightingError error() const;

 private:
  ErrorSums sums_;
  double p_ = 0, q_ = 0;
};

}  // namespace lumitexel
