#include "processing/brdf/choose_noise_shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr double kPowers[] = {3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0};
constexpr double kLeastWidth = 0.9, kMostWidth = 1.15;  // the scale is an estimate of the same samples' variance: it is not far off
constexpr int kWidths = 26;                            // a percent apart
constexpr std::size_t kSamples = 6000;                  // so many say it, as in estimate_error.cpp
constexpr double kLeastProbability = 1e-3;              // of a lumitexel for a material, as in mixture.cpp
constexpr double kNumbers = 2.0;                    // power and width

bool may_have_edges(const Mixture& mixture) {
  return std::all_of(mixture.materials.begin(), mixture.materials.end(), [](const MaterialModel& material) {
    return material.error.outlier_share > 0.0 || material.error.freedom >= ErrorModel::kGaussian;
  });
}

// The errors of one material as its samples show them, each counted by its lumitexel's share and the material's independence.
struct MaterialErrors {
  const ErrorModel* error = nullptr;
  std::vector<WhitenedSquares> samples;
  std::vector<double> weight;
};

std::vector<MaterialErrors> errors_of(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                      const Responsibilities& r) {
  std::size_t all = 0;
  for (const std::size_t i : lumitexels) all += observations.of(i).size();
  const std::size_t stride = all / kSamples + 1;
  std::vector<MaterialErrors> errors(mixture.materials.size());
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const MaterialModel& material = mixture.materials[k];
    const PreparedBrdf brdf(material.brdf);
    errors[k].error = &material.error;
    for (std::size_t l = 0; l < lumitexels.size(); l += stride) {
      if (r.at(l, k) < kLeastProbability) continue;
      for (const Observation& sample : observations.of(lumitexels[l])) {
        errors[k].samples.push_back(whitened_squares(material.error, sample, brdf.channels(), predicted_reflectance(brdf, sample.geometry)));
        errors[k].weight.push_back(r.at(l, k) * material.error.independence);
      }
    }
  }
  return errors;
}

double deviance_of(const NoiseShape& shape, const std::vector<MaterialErrors>& errors, int channels) {
  double sum = 0.0;
  for (const MaterialErrors& of_material : errors) {
    const ShapedDeviance deviance(*of_material.error, channels, shape);
    sum += ordered_sum(of_material.samples.size(), 0.0, [&](std::size_t s, double& part) {
      part += of_material.weight[s] * deviance.of(of_material.samples[s]);
    });
  }
  return sum;
}

double independent_samples(const std::vector<MaterialErrors>& errors) {
  double sum = 0.0;
  for (const MaterialErrors& of_material : errors) sum = std::accumulate(of_material.weight.begin(), of_material.weight.end(), sum);
  return sum;
}

}  // namespace

NoiseShape choose_noise_shape(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                              const Responsibilities& r) {
  NoiseShape best;
  if (lumitexels.empty() || !may_have_edges(mixture)) return best;
  const std::vector<MaterialErrors> errors = errors_of(mixture, observations, lumitexels, r);
  const int channels = observations.channels;
  double least = deviance_of(best, errors, channels) - kNumbers * std::log(std::max(2.0, independent_samples(errors)));
  for (const double power : kPowers) {
    bool better = false;
    for (int w = 0; w < kWidths; ++w) {
      const NoiseShape shape{power, kLeastWidth + (kMostWidth - kLeastWidth) * w / (kWidths - 1)};
      const double deviance = deviance_of(shape, errors, channels);
      if (!(deviance < least)) continue;
      least = deviance;
      best = shape;
      better = true;
    }
    if (!better && !best.normal()) break;  // beyond the likeliest
  }
  return best;
}

}  // namespace lumitexel
