#include "processing/brdf/shared_brightness.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

constexpr double kCorrelationKept[] = {0.0, 0.33, 0.67, 1.0};
constexpr double kLeastWeight = 1e-3;
constexpr double kScales2[] = {1.5, 1.2, 1.0, 0.85, 0.7, 0.55, 0.45, 0.35, 0.28, 0.22, 0.17, 0.13, 0.1, 0.07, 0.05};  // s^2
constexpr double kFactors[] = {0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.14, 0.2, 0.3, 0.4, 0.6};  // t

// Of one lumitexel under one material: sums over its samples, whitened by the error model.
struct Sums {
  double squares = 0;       // of residuals
  double residuals = 0;     // predictions times residuals
  double predictions = 0;   // predictions squared
  double count = 0;         // channels of samples
  double log_variances = 0; // of the error model's scales, which differ from material to material

  // Up to what s and t do not change.
  double log_likelihood(double s2, double t) const {
    const double spread = 1.0 + t * t * predictions / s2;
    const double explained = t * t * residuals * residuals / (s2 * s2) / spread;
    return -0.5 * (squares / s2 - explained + count * std::log(s2) + log_variances + std::log(spread));
  }
};

// The same for all materials, whole and parts, so that none explains more by counting less: by the one that explains the sample best.
double sample_weight(const std::vector<PreparedBrdf>& materials, const ErrorModel& error, const Observation& sample) {
  double weight = 0.0;
  for (const PreparedBrdf& brdf : materials) {
    const SampleMisfit misfit = sample_misfit(error, sample, brdf.channels(), predicted_reflectance(brdf, sample.geometry));
    weight = std::max(weight, robust_weight(error, misfit, brdf.channels()));
  }
  return std::min(1.0, weight);
}

void add(const PreparedBrdf& brdf, const ErrorModel& error, const Observation& sample, double weight, Sums& sums) {
  const int channels = brdf.channels();
  const ChannelValues predicted = predicted_reflectance(brdf, sample.geometry);
  const ScaledResiduals scaled = scaled_residuals(error, sample, channels, predicted);
  for (Eigen::Index i = 0; i < channels; ++i) {
    double residual = 0.0, prediction = 0.0;
    for (Eigen::Index j = error.whitening().size() > 0 ? 0 : i; j <= i; ++j) {
      const auto c = static_cast<std::size_t>(j);
      const double w = error.whitening().size() > 0 ? error.whitening()(i, j) : 1.0;
      residual += w * scaled.over_scale[c];
      prediction += w * predicted[c] / scaled.scale[c];
    }
    sums.squares += weight * residual * residual;
    sums.residuals += weight * residual * prediction;
    sums.predictions += weight * prediction * prediction;
  }
  sums.log_variances += weight * (std::log(sample_misfit(error, scaled, channels).variances) + error.log_determinant());
  sums.count += weight * channels;
}

// A factor that a lumitexel's samples share makes its channels go together, too, and stands in the error model as their correlation.
ErrorModel with_correlation(const ErrorModel& error, double kept, int channels) {
  if (error.whitening().size() == 0) return error;
  const ChannelMatrix precision = error.whitening().transpose() * error.whitening();
  ErrorModel result = error;
  result.set_correlation(kept * ChannelMatrix(precision.inverse()) + (1.0 - kept) * ChannelMatrix::Identity(channels, channels));
  return result;
}

// Greatest over s and t; sums: of every lumitexel under every part.
double best_log_likelihood(const std::vector<std::vector<Sums>>& sums, const std::vector<double>& log_share, const std::vector<double>& weight) {
  double best = -std::numeric_limits<double>::infinity();
  for (const double s2 : kScales2) {
    for (const double t : kFactors) {
      const double value = ordered_sum(weight.size(), 0.0, [&](std::size_t l, double& sum) {
        if (weight[l] < kLeastWeight) return;
        double most = -std::numeric_limits<double>::infinity(), rest = 0.0;
        for (std::size_t k = 0; k < log_share.size(); ++k) {
          const double own = log_share[k] + sums[k][l].log_likelihood(s2, t);
          rest = own > most ? rest * std::exp(most - own) + 1.0 : rest + std::exp(own - most);
          most = std::max(most, own);
        }
        sum += weight[l] * (most + std::log(rest));
      });
      best = std::max(best, value);
    }
  }
  return best;
}

// sums[k][l] of material k and lumitexel l. own: the error model that outliers are told by.
std::vector<std::vector<Sums>> all_sums(const std::vector<PreparedBrdf>& materials, const ErrorModel& own, const ErrorModel& error,
                                        const Observations& observations, const LumitexelList& lumitexels, const std::vector<double>& weight) {
  std::vector<std::vector<Sums>> sums(materials.size(), std::vector<Sums>(lumitexels.size()));
  for_each_block(lumitexels.size(), [&](std::size_t l) {
    if (weight[l] < kLeastWeight) return;
    for (const Observation& sample : observations.of(lumitexels[l])) {
      const double counts = sample_weight(materials, own, sample);
      for (std::size_t k = 0; k < materials.size(); ++k) add(materials[k], error, sample, counts, sums[k][l]);
    }
  });
  return sums;
}

}  // namespace

double gain_beside_shared_brightness(const MaterialModel& whole, const Mixture& parts, const Observations& observations,
                                     const LumitexelList& lumitexels, const std::vector<double>& weight) {
  std::vector<PreparedBrdf> materials{PreparedBrdf(whole.brdf)};
  std::vector<double> log_share;
  for (std::size_t k = 0; k < parts.materials.size(); ++k) {
    materials.emplace_back(parts.materials[k].brdf);
    log_share.push_back(std::log(parts.share[k]));
  }
  double alone = -std::numeric_limits<double>::infinity(), apart = alone;
  for (const double kept : kCorrelationKept) {
    const ErrorModel error = with_correlation(whole.error, kept, whole.brdf.channels);
    std::vector<std::vector<Sums>> sums = all_sums(materials, whole.error, error, observations, lumitexels, weight);
    alone = std::max(alone, best_log_likelihood({sums[0]}, {0.0}, weight));
    sums.erase(sums.begin());
    apart = std::max(apart, best_log_likelihood(sums, log_share, weight));
  }
  return apart - alone;
}

}  // namespace lumitexel
