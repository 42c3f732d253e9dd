#include "processing/brdf/select_lumitexels.h"

#include <algorithm>
#include <cmath>

#include "processing/brdf/draw_phase.h"

namespace lumitexel {
namespace {

// `count` entries at equal distances.
void take_spread(const std::vector<std::size_t>& from, std::size_t count, double phase, std::vector<std::size_t>& chosen) {
  if (from.empty()) return;
  const double step = std::max(1.0, static_cast<double>(from.size()) / static_cast<double>(count));
  for (double at = phase * step; at < static_cast<double>(from.size()); at += step) {
    chosen.push_back(from[static_cast<std::size_t>(at)]);
  }
}

}  // namespace

double mirror_nearness(std::span<const Observation> samples) {
  double nearest = -1.0;
  for (const Observation& sample : samples) {
    nearest = std::max(nearest, 1.0 / std::sqrt(1.0 + half_tangent_squared(sample.geometry)));
  }
  return nearest;
}

std::vector<std::size_t> select_lumitexels(const Observations& observations, std::size_t count, int draw) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    if (observations.of(i).size() >= kFewestSamples) usable.push_back(i);
  }
  if (usable.size() <= count) return usable;

  std::vector<std::pair<double, std::size_t>> ranked;
  for (const std::size_t i : usable) ranked.emplace_back(-mirror_nearness(observations.of(i)), i);
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(ranked.size() / 3);
  std::vector<std::size_t> likely;
  for (const auto& [nearness, i] : ranked) likely.push_back(i);
  std::sort(likely.begin(), likely.end());  // spread over the surface, not over the ranking

  std::vector<std::size_t> chosen;
  take_spread(likely, count / 2, draw_phase(draw), chosen);
  take_spread(usable, count - count / 2, draw_phase(draw), chosen);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace lumitexel
