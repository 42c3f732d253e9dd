#include "processing/brdf/choice.h"

#include <cmath>

namespace lumitexel {

Gain gain_of(const std::vector<double>& later, const std::vector<double>& earlier) {
  double difference = 0.0, squares = 0.0, total = 0.0;
  for (std::size_t i = 0; i < earlier.size(); ++i) {
    const double less = earlier[i] - later[i];
    difference += less;
    squares += less * less;
    total += earlier[i];
  }
  if (total <= 0.0) return {};
  return {difference / total, std::sqrt(squares) / total};
}

}  // namespace lumitexel
