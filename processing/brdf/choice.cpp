#include "processing/brdf/choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lumitexel {

PairedDifference paired_difference(const std::vector<double>& a, const std::vector<double>& b, Judges judges) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    sum += a[j] - b[j];
    squares += (a[j] - b[j]) * (a[j] - b[j]);
    count += a[j] != 0.0 || b[j] != 0.0;
  }
  if (judges == Judges::Lumitexels) return {sum, std::sqrt(squares)};
  if (count < 2.0) return {sum, std::numeric_limits<double>::infinity()};
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum / count) * count / (count - 1.0))};
}

Gain gain_of(const std::vector<double>& later, const std::vector<double>& earlier, Judges judges) {
  const double total = std::accumulate(earlier.begin(), earlier.end(), 0.0);
  if (total <= 0.0) return {};
  const PairedDifference less = paired_difference(earlier, later, judges);
  return {less.sum / total, less.sigma / total};
}

}  // namespace lumitexel
