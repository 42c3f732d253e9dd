#include "processing/brdf/left_out_error.h"

#include <algorithm>
#include <cmath>

#include "processing/brdf/choice.h"
#include "processing/brdf/misfit.h"
#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

constexpr double kClipPercentile = 0.999;

// exp(log_weight - max), normalised.
void normalise(std::vector<double>& log_weight) {
  const double most = *std::max_element(log_weight.begin(), log_weight.end());
  double sum = 0.0;
  for (double& w : log_weight) sum += w = std::exp(w - most);
  for (double& w : log_weight) w /= sum;
}

SquaredError left_out_error(const Mixture& mixture, const std::vector<PreparedBrdf>& prepared, std::span<const Observation> samples, int channels, double clip) {
  const std::size_t count = mixture.materials.size();
  std::vector<ChannelValues> predicted(samples.size() * count);
  std::vector<double> deviances(samples.size() * count), total(count);
  for (std::size_t k = 0; k < count; ++k) {
    const MaterialModel& material = mixture.materials[k];
    const double constant = deviance_constant(material.error, channels);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      predicted[s * count + k] = predicted_reflectance(prepared[k], samples[s].geometry);
      const SampleMisfit misfit = sample_misfit(material.error, samples[s], channels, predicted[s * count + k]);
      total[k] += deviances[s * count + k] = deviance(material.error, misfit, channels) + constant;
    }
  }
  SquaredError error;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    std::vector<double> weight(count);
    for (std::size_t k = 0; k < count; ++k) weight[k] = std::log(mixture.share[k]) - 0.5 * (total[k] - deviances[s * count + k]);
    normalise(weight);
    ChannelValues mean{};
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += weight[k] * predicted[s * count + k][c];
    }
    error += squared_error(mean, samples[s], channels, clip);
  }
  return error;
}

}  // namespace

SquaredError squared_error(const ChannelValues& predicted, const Observation& sample, int channels, double clip) {
  SquaredError error;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
    const double measured = std::max(0.0, static_cast<double>(sample.reflectance[c]));
    const double difference = std::min(predicted[c], clip) - std::min(clip, measured);
    const double of_roots = std::sqrt(std::max(predicted[c], 0.0)) - std::sqrt(measured);  // the first argument is what a NaN comes out of
    error += {difference * difference, of_roots * of_roots};
  }
  return error;
}

SquaredError& SquaredError::operator+=(const SquaredError& other) {
  clipped += other.clipped;
  root += other.root;
  return *this;
}

double clip_level(const Observations& observations, const LumitexelList& lumitexels) {
  std::vector<float> values;
  for (const std::size_t i : lumitexels) {
    for (const Observation& sample : observations.of(i)) {
      values.insert(values.end(), sample.reflectance.begin(), sample.reflectance.begin() + observations.channels);
    }
  }
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kClipPercentile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

std::vector<SquaredError> left_out_errors(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                          double clip) {
  std::vector<SquaredError> errors(lumitexels.size());
  std::vector<PreparedBrdf> prepared;
  for (const MaterialModel& material : mixture.materials) prepared.emplace_back(material.brdf);
  for_each_block(lumitexels.size(), [&](std::size_t l) {
    const auto samples = observations.of(lumitexels[l]);
    if (samples.size() >= 2) errors[l] = left_out_error(mixture, prepared, samples, observations.channels, clip);
  });
  return errors;
}

SquaredError total_error(const std::vector<SquaredError>& errors) {
  SquaredError total{1e-300, 1e-300};  // a world without errors divides nothing by zero
  for (const SquaredError& error : errors) total += error;
  return total;
}

std::vector<double> relative_errors(const std::vector<SquaredError>& errors, const SquaredError& total) {
  std::vector<double> values;
  for (const SquaredError& error : errors) values.push_back(error.clipped / total.clipped + error.root / total.root);
  return values;
}

double excess_in_standard_errors(const std::vector<double>& a, const std::vector<double>& b, Judges judges) {
  const PairedDifference difference = paired_difference(a, b, judges);
  return difference.sigma > 0.0 ? difference.sum / difference.sigma : 0.0;
}

}  // namespace lumitexel
