#include "processing/brdf/experiment/mixture_score.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

// ln p of the samples under one material, up to a constant. Its slope: the noise's size, which grows with the prediction, tells a little, too.
double log_likelihood(const PredictedSamples& material, const std::vector<SampleValues>& values, double relative_sigma,
                      Eigen::Ref<Eigen::VectorXd> slope) {
  double sum = 0.0;
  for (std::size_t s = 0; s < values.size(); ++s) {
    for (Eigen::Index c = 0; c < values[s].size(); ++c) {
      const double ratio = values[s][c] / material.value[s][c], off = (ratio - 1.0) / relative_sigma;
      sum -= std::log(material.value[s][c]) + 0.5 * off * off;
      slope += (ratio * off / relative_sigma - 1.0) * material.relative_slope[s].row(c).transpose();
    }
  }
  return sum;
}

std::vector<double> normalised(std::vector<double> logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double total = 0.0;
  for (double& value : logs) total += (value = std::exp(value - most));
  for (double& value : logs) value /= total;
  return logs;
}

}  // namespace

PredictedSamples predicted_samples(const BrdfSlopes& material, std::span<const Observation> samples) {
  PredictedSamples result{std::vector<SampleValues>(samples.size()), std::vector<SampleSlopes>(samples.size())};
  for (std::size_t s = 0; s < samples.size(); ++s) {
    material.predict(samples[s].geometry, result.value[s], result.relative_slope[s]);
    for (Eigen::Index c = 0; c < result.value[s].size(); ++c) result.relative_slope[s].row(c) /= result.value[s][c];
  }
  return result;
}

Eigen::VectorXd MixtureScore::slope() const {
  return if_known * Eigen::Map<const Eigen::VectorXd>(probability.data(), static_cast<Eigen::Index>(probability.size()));
}

MixtureScore mixture_score(const std::vector<PredictedSamples>& materials, const std::vector<double>& shares, double relative_sigma,
                           const std::vector<SampleValues>& values) {
  const auto count = static_cast<Eigen::Index>(materials.size());
  const Eigen::Index own = materials.front().relative_slope.front().cols();
  MixtureScore score{std::vector<double>(materials.size()), Eigen::MatrixXd::Zero(count * own + count - 1, count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto material = static_cast<std::size_t>(k);
    const double log_p = log_likelihood(materials[material], values, relative_sigma, score.if_known.col(k).segment(k * own, own));
    score.probability[material] = std::log(shares[material]) + log_p;
    // The last share is what the others leave.
    if (k + 1 < count) score.if_known(count * own + k, k) = 1.0 / shares[material];
    else score.if_known.col(k).tail(count - 1).setConstant(-1.0 / shares[material]);
  }
  score.probability = normalised(std::move(score.probability));
  return score;
}

}  // namespace lumitexel
