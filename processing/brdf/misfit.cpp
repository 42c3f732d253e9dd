#include "processing/brdf/misfit.h"

#include <cmath>

namespace lumitexel {
namespace {

double misfit_of(const LafortuneBrdf& brdf, const Observation& sample, const ErrorModel& error) {
  double squares = 0.0, sum = 0.0;
  for (int c = 0; c < brdf.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const double predicted = predicted_reflectance(brdf, c, sample.geometry);
    const double variance = error.variance(predicted, static_cast<double>(sample.variance[channel]));
    const double residual = predicted - static_cast<double>(sample.reflectance[channel]);
    squares += residual * residual / variance;
    sum += std::log(variance);
  }
  return sum + (kFreedom + brdf.channels) * std::log1p(squares / kFreedom);
}

}  // namespace

double misfit(const LafortuneBrdf& brdf, std::span<const Observation> samples, const ErrorModel& error) {
  double sum = 0.0;
  for (const Observation& sample : samples) sum += misfit_of(brdf, sample, error);
  return sum;
}

double misfit(const LafortuneBrdf& brdf, std::span<const Observation* const> samples, const ErrorModel& error) {
  double sum = 0.0;
  for (const Observation* sample : samples) sum += misfit_of(brdf, *sample, error);
  return sum;
}

}  // namespace lumitexel
