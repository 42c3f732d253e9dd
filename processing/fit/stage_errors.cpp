#include "processing/fit/stage_errors.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

namespace lumitexel {
namespace {

double predict(const Model& model, FitStage stage, int material, const TexelWeights& weights, int c,
               const LobeGeometry& geometry) {
  if (stage == FitStage::Single) return predicted_reflectance(model.single, c, geometry);
  const ModelMaterial& chosen = model.materials[static_cast<std::size_t>(material)];
  if (stage == FitStage::Cluster) return predicted_reflectance(chosen.brdf, c, geometry);
  double value = 0.0;
  for (std::size_t k = 0; k < chosen.basis.size(); ++k) {
    if (weights.weight[k] > 0.0f) value += static_cast<double>(weights.weight[k]) * predicted_reflectance(chosen.basis[k], c, geometry);
  }
  return value;
}

}  // namespace

StageError stage_error(const Model& model, FitStage stage, const Observations& observations, const std::vector<int>& label,
                       const std::vector<TexelWeights>& weights) {
  const auto channels = static_cast<std::size_t>(observations.channels);
  // Squares per lumitexel and channel first, so that the sums below run in one order whatever the threads did.
  std::vector<double> squares(observations.lumitexels() * channels, 0.0);
  oneapi::tbb::parallel_for(std::size_t{0}, observations.lumitexels(), [&](std::size_t i) {
    for (const Observation& sample : observations.of(i)) {
      for (std::size_t c = 0; c < channels; ++c) {
        const double residual = predict(model, stage, label[i], weights[i], static_cast<int>(c), sample.geometry) -
                                static_cast<double>(sample.reflectance[c]);
        squares[i * channels + c] += residual * residual;
      }
    }
  });
  StageError error;
  error.by_channel.assign(channels, 0.0);
  error.by_material.assign(model.materials.size(), 0.0);
  std::vector<double> samples_of(model.materials.size(), 0.0);
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    const auto material = static_cast<std::size_t>(label[i]);
    samples_of[material] += static_cast<double>(observations.of(i).size());
    for (std::size_t c = 0; c < channels; ++c) {
      error.by_channel[c] += squares[i * channels + c];
      error.by_material[material] += squares[i * channels + c];
      error.rms += squares[i * channels + c];
    }
  }
  const double samples = std::max<double>(1.0, static_cast<double>(observations.samples.size()));
  const auto channel_count = static_cast<double>(channels);
  error.rms = std::sqrt(error.rms / (samples * channel_count));
  for (double& value : error.by_channel) value = std::sqrt(value / samples);
  for (std::size_t j = 0; j < samples_of.size(); ++j) {
    error.by_material[j] = std::sqrt(error.by_material[j] / std::max(1.0, samples_of[j] * channel_count));
  }
  return error;
}

}  // namespace lumitexel
