#include "processing/brdf/misfit.h"

#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

SampleMisfit misfit_of(const PreparedBrdf& brdf, const Observation& sample, const ErrorModel& error) {
  return sample_misfit(error, sample, brdf.channels(), predicted_reflectance(brdf, sample.geometry));
}

}  // namespace

PreparedMisfit::PreparedMisfit(const Brdf& brdf, const ErrorModel& error)
    : brdf_(brdf), error_(error), constant_(deviance_constant(error, brdf.channels)) {}

double PreparedMisfit::of(std::span<const Observation> samples) const {
  DevianceSum sum(error_, brdf_.channels());
  for (const Observation& sample : samples) sum.add(misfit_of(brdf_, sample, error_));
  return sum.total() + static_cast<double>(samples.size()) * constant_;
}

double misfit(const Brdf& brdf, std::span<const Observation> samples, const ErrorModel& error) {
  return PreparedMisfit(brdf, error).of(samples);
}

double misfit(const Brdf& brdf, FitSamples samples, const ErrorModel& error) {
  const PreparedBrdf prepared(brdf);
  const double constant = deviance_constant(error, brdf.channels);
  return ordered_sum(samples.size(), 0.0, [&](std::size_t s, double& sum) {
    const SampleMisfit misfit = misfit_of(prepared, *samples[s].observation, error);
    sum += samples[s].share * (deviance(error, misfit, brdf.channels) + constant);
  });
}

}  // namespace lumitexel
