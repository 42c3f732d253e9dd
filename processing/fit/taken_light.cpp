#include "processing/fit/taken_light.h"

#include <cmath>

namespace lumitexel {
namespace {

double square(double x) { return x * x; }

// The share of the model's indirect light that is to be taken, from sums over a lumitexel: t of the header, so that (measured - t) / indirect.
// All of it where a sum is not positive, and nothing follows from them.
double share_to_take(double measured, double fitted, double indirect) {
  if (!(measured > 0.0 && fitted > 0.0 && indirect > 0.0)) return 1.0;
  const double straight = 2.0 * measured / (1.0 + std::sqrt(1.0 + 4.0 * measured * indirect / square(fitted)));
  return (measured - straight) / indirect;
}

}  // namespace

void scale_to_take(const LumitexelTile& tile, int channels, const std::vector<float>& photographed, const std::vector<float>& taken_before,
                   std::vector<float>& light, std::vector<float>& light_variance) {
  const auto stride = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < tile.size(); ++i) {
    for (std::size_t c = 0; c < stride; ++c) {
      double measured = 0.0, taken = 0.0, indirect = 0.0;
      const std::size_t first = tile.first_sample[i] * stride + c, last = tile.first_sample[i + 1] * stride + c;
      for (std::size_t k = first; k < last; k += stride) {
        measured += static_cast<double>(photographed[k]);
        taken += static_cast<double>(taken_before[k]);
        indirect += static_cast<double>(light[k]);
      }
      const double share = share_to_take(measured, measured - taken, indirect);
      for (std::size_t k = first; k < last; k += stride) {
        light[k] *= static_cast<float>(share);
        light_variance[k] *= static_cast<float>(square(share));
      }
    }
  }
}

void even_out_variance(const std::vector<float>& photographed_variance, int channels, LumitexelTile& tile) {
  const auto stride = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < tile.size(); ++i) {
    for (std::size_t c = 0; c < stride; ++c) {
      const std::size_t first = tile.first_sample[i] * stride + c, last = tile.first_sample[i + 1] * stride + c;
      double variance = 0.0;
      for (std::size_t k = first; k < last; k += stride) variance += static_cast<double>(tile.variance[k] - photographed_variance[k]);
      const double mean = first < last ? variance * static_cast<double>(channels) / static_cast<double>(last - first) : 0.0;
      for (std::size_t k = first; k < last; k += stride) tile.variance[k] = photographed_variance[k] + static_cast<float>(mean);
    }
  }
}

}  // namespace lumitexel
