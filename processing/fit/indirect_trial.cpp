#include "processing/fit/indirect_trial.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFewestSamples = 4;  // of a lumitexel: with fewer, a factor and noise explain anything

// Each sample over its variance.
struct Sums {
  double residual_light = 0, light_light = 0;

  Sums& operator+=(const Sums& other) {
    residual_light += other.residual_light;
    light_light += other.light_light;
    return *this;
  }
  Sums without(const Sums& part) const { return {residual_light - part.residual_light, light_light - part.light_light}; }
  double slope() const { return residual_light / light_light; }
};

struct SumsByView {
  std::vector<Sums> view;
  std::size_t samples = 0;
  SumsByView& operator+=(const SumsByView& other) {
    for (std::size_t v = 0; v < view.size(); ++v) view[v] += other.view[v];
    samples += other.samples;
    return *this;
  }
};

// One channel of one lumitexel, by sample.
struct Channel {
  std::vector<double> predicted, residual, light, light_variance, weight;

  void clear() {
    for (auto* values : {&predicted, &residual, &light, &light_variance, &weight}) values->clear();
  }
  // Of the prediction with itself.
  double own() const {
    double sum = 0.0;
    for (std::size_t s = 0; s < weight.size(); ++s) sum += weight[s] * predicted[s] * predicted[s];
    return sum;
  }
  // Without what a factor on the prediction explains; nothing is where it is zero.
  void leave_factor_out(std::vector<double>& values) const {
    double both = 0.0;
    for (std::size_t s = 0; s < values.size(); ++s) both += weight[s] * predicted[s] * values[s];
    if (both == 0.0) return;
    const double factor = both / own();
    for (std::size_t s = 0; s < values.size(); ++s) values[s] -= predicted[s] * factor;
  }
  // By how much paths' scatter adds to the square of a sample's light once that factor is out, over its variance.
  double remaining_scatter(std::size_t s, double own_sum) const {
    const double leverage = own_sum > 0.0 ? weight[s] * predicted[s] * predicted[s] / own_sum : 0.0;
    return weight[s] * light_variance[s] * (1.0 - leverage);
  }
};

class Regression {
 public:
  Regression(const Observations& before, const Observations& without, const Model& model, const std::vector<int>& label,
             const std::vector<TexelWeights>& weights, const ErrorModel& error)
      : before_(before), without_(without), label_(label), weights_(weights), error_(error) {
    for (const ModelMaterial& material : model.materials) basis_.emplace_back(material.basis.begin(), material.basis.end());
  }

  void add(std::size_t lumitexel, SumsByView& sums) const {
    const auto samples = before_.of(lumitexel);
    if (samples.size() < kFewestSamples || without_.of(lumitexel).size() != samples.size() || !has_light(lumitexel)) return;
    std::vector<ChannelValues> predicted;
    const std::vector<PreparedBrdf>& basis = basis_[static_cast<std::size_t>(label_[lumitexel])];
    for (const Observation& sample : samples) predicted.push_back(predicted_reflectance(basis, weights_[lumitexel].weight, sample.geometry));
    Channel channel;
    for (std::size_t c = 0; c < static_cast<std::size_t>(before_.channels); ++c) {
      take(lumitexel, c, predicted, channel);
      channel.leave_factor_out(channel.residual);
      channel.leave_factor_out(channel.light);
      const double own = channel.own();
      for (std::size_t s = 0; s < samples.size(); ++s) {
        Sums& sum = sums.view[before_.view[before_.first[lumitexel] + s]];
        sum.residual_light += channel.weight[s] * channel.residual[s] * channel.light[s];
        sum.light_light += channel.weight[s] * channel.light[s] * channel.light[s] - channel.remaining_scatter(s, own);
      }
    }
    sums.samples += samples.size();
  }

 private:
  double light(std::size_t lumitexel, std::size_t s, std::size_t c) const {
    return static_cast<double>(before_.of(lumitexel)[s].reflectance[c] - without_.of(lumitexel)[s].reflectance[c]);
  }

  bool has_light(std::size_t lumitexel) const {
    for (std::size_t s = 0; s < before_.of(lumitexel).size(); ++s) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(before_.channels); ++c) {
        if (light(lumitexel, s, c) != 0.0) return true;
      }
    }
    return false;
  }

  // Weights as Student's t has it: a shadow that the mesh misses must not decide.
  void take(std::size_t lumitexel, std::size_t c, const std::vector<ChannelValues>& predicted, Channel& channel) const {
    channel.clear();
    const auto samples = before_.of(lumitexel);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const double variance = error_.variance(predicted[s][c], static_cast<double>(samples[s].variance[c]));
      const double residual = static_cast<double>(samples[s].reflectance[c]) - predicted[s][c];
      channel.predicted.push_back(predicted[s][c]);
      channel.residual.push_back(residual);
      channel.light.push_back(light(lumitexel, s, c));
      channel.light_variance.push_back(static_cast<double>(without_.of(lumitexel)[s].variance[c] - samples[s].variance[c]));
      channel.weight.push_back((error_.freedom + 1.0) / (error_.freedom + residual * residual / variance) / variance);
    }
  }

  const Observations &before_, &without_;
  const std::vector<int>& label_;
  const std::vector<TexelWeights>& weights_;
  const ErrorModel& error_;
  std::vector<std::vector<PreparedBrdf>> basis_;
};

// Photographs are what errs independently: a pose or a lamp that is off bends all samples of its own. Each is left out once (jackknife): one that
// decides alone shows so, where deviations from a slope that it has drawn to itself would not.
IndirectWorth worth_of(const SumsByView& sums) {
  std::vector<Sums> photographs;
  std::copy_if(sums.view.begin(), sums.view.end(), std::back_inserter(photographs), [](const Sums& view) { return view.light_light != 0.0; });
  Sums all;
  for (const Sums& one : photographs) all += one;
  IndirectWorth worth;
  worth.samples = sums.samples;
  worth.photographs = photographs.size();
  if (!(all.light_light > 0.0)) return worth;
  worth.slope = all.slope();
  if (photographs.size() < 2) return worth;
  const auto count = static_cast<double>(photographs.size());
  double mean = 0.0, squares = 0.0;
  for (const Sums& one : photographs) mean += all.without(one).slope() / count;
  for (const Sums& one : photographs) squares += std::pow(all.without(one).slope() - mean, 2);
  worth.sigma = std::sqrt(squares * (count - 1.0) / count);
  return worth;
}

}  // namespace

IndirectWorth try_without_indirect(const Observations& before, const Observations& without, const Model& model, const std::vector<int>& label,
                                   const std::vector<TexelWeights>& weights, const ErrorModel& error) {
  const Regression regression(before, without, model, label, weights, error);
  SumsByView zero;
  const auto last = std::max_element(before.view.begin(), before.view.end());
  zero.view.resize(last == before.view.end() ? 0 : *last + std::size_t{1});
  return worth_of(ordered_sum(before.lumitexels(), zero, [&](std::size_t i, SumsByView& sums) { regression.add(i, sums); }));
}

}  // namespace lumitexel
