#include "processing/brdf/lobe_starts.h"

#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

constexpr std::size_t kMostSamples = 4000;
constexpr double kExponents[] = {3, 10, 30, 100, 300, 1000};
constexpr double kPhis[] = {0.7853981633974483, 0.70, 0.87};
// A lobe that the samples do not want at all starts here, small but able to grow: ln of 1e-4 per sr.
constexpr double kFaintLogPeak = -9.2;

struct ChannelSolution {
  double diffuse = 0, peak = 0, cost = 0;
};

// Non-negative least squares in two unknowns: min sum w (kd x + A y - r)^2.
ChannelSolution solve_channel(double xx, double xy, double yy, double xr, double yr, double rr) {
  const auto cost = [&](double kd, double peak) {
    return rr + kd * kd * xx + peak * peak * yy + 2.0 * (kd * peak * xy - kd * xr - peak * yr);
  };
  ChannelSolution best{xx > 0.0 ? std::max(0.0, xr / xx) : 0.0, 0.0, 0.0};
  best.cost = cost(best.diffuse, 0.0);
  const auto offer = [&](double kd, double peak) {
    if (kd >= 0.0 && peak >= 0.0 && cost(kd, peak) < best.cost) best = {kd, peak, cost(kd, peak)};
  };
  if (yy > 0.0) offer(0.0, yr / yy);
  const double determinant = xx * yy - xy * xy;
  if (determinant > 1e-12 * xx * yy) offer((xr * yy - yr * xy) / determinant, (yr * xx - xr * xy) / determinant);
  return best;
}

double solve_shape(std::span<const Observation* const> samples, std::size_t stride, const ErrorModel& error,
                   LafortuneBrdf& brdf) {
  LafortuneBrdf unit = brdf;  // the lobe alone, with a peak of one
  for (auto& lobe : unit.lobes[0]) lobe.log_peak = 0.0;
  unit.diffuse.fill(0.0);
  double total = 0.0;
  for (int c = 0; c < brdf.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0, rr = 0;
    for (std::size_t s = 0; s < samples.size(); s += stride) {
      const double r = static_cast<double>(samples[s]->reflectance[channel]);
      // No model yet: the measurement stands in for it, which is biased but near enough to start from.
      const double w = 1.0 / error.variance(std::max(0.0, r), static_cast<double>(samples[s]->variance[channel]));
      const double x = samples[s]->geometry.cos_i;
      const double y = predicted_reflectance(unit, c, samples[s]->geometry);
      xx += w * x * x;
      xy += w * x * y;
      yy += w * y * y;
      xr += w * x * r;
      yr += w * y * r;
      rr += w * r * r;
    }
    const ChannelSolution solution = solve_channel(xx, xy, yy, xr, yr, rr);
    brdf.diffuse[channel] = solution.diffuse;
    brdf.lobes[0][channel].log_peak = std::max(kFaintLogPeak, std::log(std::max(1e-300, solution.peak)));
    total += solution.cost;
  }
  return total;
}

}  // namespace

LafortuneBrdf best_lobe_start(std::span<const Observation* const> samples, int channels, const ErrorModel& error) {
  const std::size_t stride = samples.size() / kMostSamples + 1;
  LafortuneBrdf best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const double phi : kPhis) {
    for (const double exponent : kExponents) {
      LafortuneBrdf candidate;
      candidate.channels = channels;
      candidate.lobes.resize(1);
      for (auto& lobe : candidate.lobes[0]) lobe = {0.0, phi, std::log(exponent)};
      const double cost = solve_shape(samples, stride, error, candidate);
      if (cost < best_cost) {
        best_cost = cost;
        best = candidate;
      }
    }
  }
  return best;
}

}  // namespace lumitexel
