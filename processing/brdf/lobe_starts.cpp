#include "processing/brdf/lobe_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/brdf/nnls.h"
#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostSamples = 4000;
// A lobe that the samples do not want at all starts here, small but able to grow: ln of 1e-4.
constexpr double kFaintLogStrength = -9.2;

struct System {
  BasisMatrix matrix;
  BasisVector right;
  double squares = 0;
};

// One channel's linear problem in (kd, strengths), at the lobe shapes of `brdf`.
System channel_system(const Brdf& brdf, std::size_t channel, FitSamples samples, std::size_t stride, const ErrorModel& error) {
  const auto n = static_cast<Eigen::Index>(brdf.lobes.size() + 1);
  System system{BasisMatrix::Zero(n, n), BasisVector::Zero(n), 0.0};
  const LobeFamily& family = lobe_family(brdf.family);
  std::vector<LobeShape> shapes;
  for (const auto& lobe : brdf.lobes) shapes.push_back(family.shape(lobe[channel].log_shape, lobe[channel].aim));
  for (std::size_t s = 0; s < samples.size(); s += stride) {
    const Observation& sample = *samples[s].observation;
    const double r = static_cast<double>(sample.reflectance[channel]), cos_i = sample.geometry.cos_i;
    // No model yet: the measurement stands in for it, which is biased but near enough to start from.
    const double weight = samples[s].share / error.variance(std::max(0.0, r), static_cast<double>(sample.variance[channel]));
    BasisVector row(n);
    row[0] = cos_i;
    double target = r;
    for (std::size_t l = 0; l < shapes.size(); ++l) {
      const LobeTerms terms = family.terms_of(shapes[l], sample.geometry);
      row[static_cast<Eigen::Index>(l) + 1] = cos_i * terms.gain;
      target -= cos_i * terms.offset;
    }
    system.matrix += weight * row * row.transpose();
    system.right += weight * target * row;
    system.squares += weight * target * target;
  }
  return system;
}

// Sets kd and strengths of every channel to their best; returns the cost.
double solve_strengths(FitSamples samples, std::size_t stride, const ErrorModel& error, Brdf& brdf) {
  double cost = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(brdf.channels); ++c) {
    const System system = channel_system(brdf, c, samples, stride, error);
    const BasisVector x = solve_nnls(system.matrix, system.right).weights;
    cost += x.dot(system.matrix * x) - 2.0 * x.dot(system.right) + system.squares;
    brdf.diffuse[c] = x[0];
    for (std::size_t l = 0; l < brdf.lobes.size(); ++l) {
      const double strength = x[static_cast<Eigen::Index>(l) + 1];
      brdf.lobes[l][c].log_strength = strength > 0.0 ? std::max(kFaintLogStrength, std::log(strength)) : kFaintLogStrength;
    }
  }
  return cost;
}

std::vector<double> aims_within(const LobeFamily& family, const AimRange& range) {
  if (!family.aims) return {kMirrorAim};
  const double middle = 0.5 * (range.least + range.most), reach = 0.3 * (range.most - range.least);
  return {middle, middle - reach, middle + reach};
}

}  // namespace

Brdf with_best_lobe(const Brdf& brdf, FitSamples samples, const LobeBounds& bounds, const ErrorModel& error) {
  const std::size_t stride = samples.size() / kMostSamples + 1;
  const LobeFamily& family = lobe_family(brdf.family);
  Brdf best = brdf;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const double aim : aims_within(family, bounds.aim)) {
    for (const double log_shape : family.start_log_shapes) {
      if (log_shape < bounds.least_log_shape || log_shape > bounds.most_log_shape) continue;
      Brdf candidate = brdf;
      candidate.lobes.emplace_back().fill(Lobe{0.0, log_shape, aim});
      const double cost = solve_strengths(samples, stride, error, candidate);
      if (!(cost < best_cost)) continue;
      best_cost = cost;
      best = candidate;
    }
  }
  return best;
}

Brdf diffuse_alone(FitSamples samples, const ErrorModel& error, const Brdf& at) {
  Brdf matte;
  matte.family = at.family;
  matte.channels = at.channels;
  for (std::size_t c = 0; c < static_cast<std::size_t>(matte.channels); ++c) {
    struct Sums {
      double xr = 0, xx = 0;
      Sums& operator+=(const Sums& other) { return xr += other.xr, xx += other.xx, *this; }
    };
    const Sums sums = ordered_sum(samples.size(), Sums{}, [&](std::size_t s, Sums& sum) {
      const Observation& sample = *samples[s].observation;
      const double w = samples[s].share / error.variance(predicted_reflectance(at, static_cast<int>(c), sample.geometry),
                                                         static_cast<double>(sample.variance[c]));
      sum.xr += w * sample.geometry.cos_i * static_cast<double>(sample.reflectance[c]);
      sum.xx += w * sample.geometry.cos_i * sample.geometry.cos_i;
    });
    matte.diffuse[c] = sums.xx > 0.0 ? std::max(0.0, sums.xr / sums.xx) : 0.0;
  }
  return matte;
}

}  // namespace lumitexel
