#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

double deviance_of(const Brdf& brdf, const Observation& sample, const ErrorModel& error) {
  return deviance(error, sample_misfit(error, sample, brdf.channels, predicted_reflectance(brdf, sample.geometry)), brdf.channels);
}

}  // namespace

double misfit(const Brdf& brdf, std::span<const Observation> samples, const ErrorModel& error) {
  double sum = static_cast<double>(samples.size()) * deviance_constant(error, brdf.channels);
  for (const Observation& sample : samples) sum += deviance_of(brdf, sample, error);
  return sum;
}

double misfit(const Brdf& brdf, FitSamples samples, const ErrorModel& error) {
  const double constant = deviance_constant(error, brdf.channels);
  double sum = 0.0;
  for (const FitSample& sample : samples) sum += sample.share * (deviance_of(brdf, *sample.observation, error) + constant);
  return sum;
}

}  // namespace lumitexel
