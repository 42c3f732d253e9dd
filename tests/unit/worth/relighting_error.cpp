#include "tests/unit/worth/relighting_error.h"

#include <algorithm>

namespace lumitexel {

void RelightingSums::add(const Image& prediction, const Image& given, const std::vector<std::uint8_t>& counted) {
  sums_.add(prediction, given, counted);
  const double peak = percentile(given, counted, 0.999);
  const auto channels = static_cast<std::size_t>(given.channels);
  for (std::size_t i = 0; i < given.data.size(); ++i) {
    if (counted[i / channels] == 0) continue;
    p_ += std::min<double>(prediction.data[i], peak);
    q_ += std::min<double>(given.data[i], peak);
  }
}

RelightingError RelightingSums::error() const {
  const ImageError error = sums_.error();
  return {error.clipped_rms, error.sqrt_rms, p_ / q_ - 1.0};
}

}  // namespace lumitexel
