#include "processing/fit/error_spread.h"

#include <cmath>

namespace lumitexel {
namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// NaN of fewer than two.
double variance_of(const std::vector<double>& values) {
  if (values.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / static_cast<double>(values.size() - 1);
}

}  // namespace

ErrorWithSpread over_draws(const std::vector<HeldoutError>& draws) {
  ErrorWithSpread result;
  if (draws.empty()) return result;
  std::vector<double> by_draw, by_view(draws.front().by_view.size(), 0.0);
  for (const HeldoutError& draw : draws) {
    by_draw.push_back(draw.pooled);
    for (std::size_t v = 0; v < by_view.size(); ++v) by_view[v] += draw.by_view.at(v) / static_cast<double>(draws.size());
  }
  const double draw_variance = variance_of(by_draw), view_variance = variance_of(by_view);
  result.value = mean_of(by_draw);
  result.draw_deviation = std::sqrt(draw_variance);
  const double draw_part = draws.size() > 1 ? draw_variance / static_cast<double>(draws.size()) : 0.0;
  result.sigma = std::sqrt(view_variance / static_cast<double>(by_view.size()) + draw_part);
  return result;
}

HeldoutError difference(const HeldoutError& a, const HeldoutError& b) {
  HeldoutError result{a.pooled - b.pooled, {}};
  for (std::size_t v = 0; v < a.by_view.size(); ++v) result.by_view.push_back(a.by_view[v] - b.by_view.at(v));
  return result;
}

}  // namespace lumitexel
