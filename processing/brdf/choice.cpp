#include "processing/brdf/choice.h"

#include <cmath>
#include <numeric>

namespace lumitexel {

PairedDifference paired_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t l = 0; l < a.size(); ++l) {
    sum += a[l] - b[l];
    squares += (a[l] - b[l]) * (a[l] - b[l]);
  }
  return {sum, std::sqrt(squares)};
}

Gain gain_of(const std::vector<double>& later, const std::vector<double>& earlier) {
  const double total = std::accumulate(earlier.begin(), earlier.end(), 0.0);
  if (total <= 0.0) return {};
  const PairedDifference less = paired_difference(earlier, later);
  return {less.sum / total, less.sigma / total};
}

}  // namespace lumitexel
