#include "processing/brdf/experiment/label_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/brdf/misfit.h"
#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

constexpr double kRoundingOfFloat = 2e-7;  // measurements are floats: the edges of a uniform law are not sharper
constexpr double kOutlierSpread = 1.0;     // rms of the factor 0 … 3 less one

std::vector<double> log_shares(const FiveMaterials& world) {
  std::vector<double> shares = material_shares(world);
  for (double& share : shares) share = std::log(share);
  return shares;
}

// Density of one sample's channels under uniform noise, times the product of the predictions and 2 noise, which is about the same for
// all materials but counts: it is put back by the caller.
double uniform_density(const FiveMaterialsOptions& options, const Observation& sample, const ChannelValues& exact) {
  const double least = 1.0 - options.noise - kRoundingOfFloat, most = 1.0 + options.noise + kRoundingOfFloat;
  bool inside = true;
  // Factors that an outlier may have had, of those from 0 to kMostFactor.
  double low = 0.0, high = kMostOutlierFactor;
  for (std::size_t c = 0; c < 3; ++c) {
    const double ratio = static_cast<double>(sample.reflectance[c]) / exact[c];
    inside = inside && ratio >= least && ratio <= most;
    low = std::max(low, ratio / most);
    high = std::min(high, ratio / least);
  }
  const double right = inside ? 1.0 - options.outliers : 0.0;
  if (options.outliers <= 0.0 || !(low < high)) return right;
  // The integral of w^-3 dw / kMostFactor, each channel's density falling as 1 / w.
  return right + options.outliers * 0.5 * (1.0 / (low * low) - 1.0 / (high * high)) / kMostOutlierFactor;
}

double log_likelihood_uniform(const FiveMaterials& world, const PreparedBrdf& material, std::span<const Observation> samples) {
  double sum = 0.0;
  for (const Observation& sample : samples) {
    const ChannelValues exact = predicted_reflectance(material, sample.geometry);
    sum += std::log(uniform_density(world.options, sample, exact)) - std::log(exact[0] * exact[1] * exact[2]);
  }
  return sum;
}

// log_likelihood(material, samples of a lumitexel)
template <typename LogLikelihood>
double accuracy(const FiveMaterials& world, const LogLikelihood& log_likelihood) {
  const std::vector<double> shares = log_shares(world);
  const double right = ordered_sum(world.label.size(), 0.0, [&](std::size_t i, double& sum) {
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < world.truth.size(); ++k) {
      const double value = shares[k] + log_likelihood(k, world.observations.of(i));
      if (value > most) most = value, best = k;
    }
    sum += static_cast<int>(best) == world.label[i];
  });
  return right / static_cast<double>(world.label.size());
}

}  // namespace

double bayes_accuracy(const FiveMaterials& world) {
  if (world.options.gaussian) return accuracy_by_normal_noise(world);
  std::vector<PreparedBrdf> materials(world.truth.begin(), world.truth.end());
  return accuracy(world, [&](std::size_t k, std::span<const Observation> samples) {
    return log_likelihood_uniform(world, materials[k], samples);
  });
}

double accuracy_by_normal_noise(const FiveMaterials& world) {
  ErrorModel error(world.relative_sigma, 1e-9);
  error.freedom = ErrorModel::kGaussian;
  error.outlier_share = world.options.outliers;
  error.outlier_scale = kOutlierSpread / world.relative_sigma;
  std::vector<PreparedMisfit> materials;
  for (const Brdf& brdf : world.truth) materials.emplace_back(brdf, error);
  return accuracy(world, [&](std::size_t k, std::span<const Observation> samples) { return -0.5 * materials[k].of(samples); });
}

}  // namespace lumitexel
