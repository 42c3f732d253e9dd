#include "tests/bench/material_errors.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nan("");
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

RelativeErrors relative_errors(const BrdfValues& truth, const BrdfValues& fit, std::span<const LobeGeometry> directions) {
  std::vector<double> right, seen;
  for (const LobeGeometry& g : directions) {
    const ChannelValues t = truth(g), f = fit(g);
    for (std::size_t c = 0; c < 3; ++c) {
      right.push_back(t[c] * g.cos_i);
      seen.push_back(f[c] * g.cos_i);
    }
  }
  const double most = quantile(right, 0.999);
  struct Sums {
    double difference = 0, truth = 0;
    void add(double t, double f) { difference += (f - t) * (f - t), truth += t * t; }
    double relative() const { return std::sqrt(difference / truth); }
  } raw, clipped, roots;
  for (std::size_t i = 0; i < right.size(); ++i) {
    raw.add(right[i], seen[i]);
    clipped.add(std::min(most, right[i]), std::min(most, seen[i]));
    roots.add(std::sqrt(right[i]), std::sqrt(std::max(0.0, seen[i])));
  }
  return {raw.relative(), clipped.relative(), roots.relative()};
}

}  // namespace lumitexel
