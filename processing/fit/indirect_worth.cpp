#include "processing/fit/indirect_worth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFewestSamples = 4;  // of a lumitexel: with fewer, a factor and noise explain anything

// Of one photograph, each sample over its variance.
struct Sums {
  double residual_light = 0, light_light = 0;
};

struct SumsByView {
  std::vector<Sums> view;
  std::size_t samples = 0;
  SumsByView& operator+=(const SumsByView& other) {
    for (std::size_t v = 0; v < view.size(); ++v) {
      view[v].residual_light += other.view[v].residual_light;
      view[v].light_light += other.view[v].light_light;
    }
    samples += other.samples;
    return *this;
  }
};

// One channel of one lumitexel, by sample.
struct Channel {
  std::vector<double> predicted, residual, light, weight;

  void clear() {
    for (auto* values : {&predicted, &residual, &light, &weight}) values->clear();
  }
  // Without what a factor on the prediction explains.
  void leave_factor_out(std::vector<double>& values) const {
    double both = 0.0, own = 0.0;
    for (std::size_t s = 0; s < values.size(); ++s) {
      both += weight[s] * predicted[s] * values[s];
      own += weight[s] * predicted[s] * predicted[s];
    }
    if (!(own > 0.0)) return;
    for (std::size_t s = 0; s < values.size(); ++s) values[s] -= predicted[s] * both / own;
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
    if (samples.size() < kFewestSamples || !has_light(lumitexel)) return;
    std::vector<ChannelValues> predicted;
    for (const Observation& sample : samples) predicted.push_back(prediction(lumitexel, sample.geometry));
    Channel channel;
    for (std::size_t c = 0; c < static_cast<std::size_t>(before_.channels); ++c) {
      take(lumitexel, c, predicted, channel);
      channel.leave_factor_out(channel.residual);
      channel.leave_factor_out(channel.light);
      for (std::size_t s = 0; s < samples.size(); ++s) {
        Sums& sum = sums.view[before_.view[before_.first[lumitexel] + s]];
        sum.residual_light += channel.weight[s] * channel.residual[s] * channel.light[s];
        sum.light_light += channel.weight[s] * channel.light[s] * channel.light[s];
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

  ChannelValues prediction(std::size_t lumitexel, const LobeGeometry& geometry) const {
    const auto& basis = basis_[static_cast<std::size_t>(label_[lumitexel])];
    ChannelValues sum{};
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const auto weight = static_cast<double>(weights_[lumitexel].weight[k]);
      if (!(weight > 0.0)) continue;
      const ChannelValues value = predicted_reflectance(basis[k], geometry);
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += weight * value[c];
    }
    return sum;
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
      channel.weight.push_back((error_.freedom + 1.0) / (error_.freedom + residual * residual / variance) / variance);
    }
  }

  const Observations &before_, &without_;
  const std::vector<int>& label_;
  const std::vector<TexelWeights>& weights_;
  const ErrorModel& error_;
  std::vector<std::vector<PreparedBrdf>> basis_;
};

// Photographs are what errs independently: a pose or a lamp that is off bends all samples of its own.
IndirectWorth worth_of(const SumsByView& sums) {
  Sums all;
  double photographs = 0.0;
  for (const Sums& view : sums.view) {
    all.residual_light += view.residual_light;
    all.light_light += view.light_light;
    photographs += view.light_light > 0.0;
  }
  IndirectWorth worth;
  worth.samples = sums.samples;
  if (!(all.light_light > 0.0)) return worth;
  worth.slope = all.residual_light / all.light_light;
  if (photographs < 2.0) return worth;
  double squares = 0.0;
  for (const Sums& view : sums.view) {
    const double off = view.residual_light - worth.slope * view.light_light;
    squares += off * off;
  }
  worth.sigma = std::sqrt(squares * photographs / (photographs - 1.0)) / all.light_light;
  return worth;
}

}  // namespace

IndirectWorth indirect_worth(const Observations& before, const Observations& without, const Model& model, const std::vector<int>& label,
                             const std::vector<TexelWeights>& weights, const ErrorModel& error) {
  if (before.first != without.first) throw std::logic_error("indirect_worth: the samples with and without light between surfaces are not the same");
  const Regression regression(before, without, model, label, weights, error);
  SumsByView zero;
  const auto last = std::max_element(before.view.begin(), before.view.end());
  zero.view.resize(last == before.view.end() ? 0 : *last + std::size_t{1});
  return worth_of(ordered_sum(before.lumitexels(), zero, [&](std::size_t i, SumsByView& sums) { regression.add(i, sums); }));
}

}  // namespace lumitexel
