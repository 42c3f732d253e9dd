#include "processing/brdf/error_choice.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "processing/brdf/estimate_error.h"
#include "processing/brdf/left_out_error.h"

namespace lumitexel {
namespace {

constexpr double kStandardErrors = 2.0;

double clipped_error(const Brdf& brdf, std::span<const Observation> samples, double clip) {
  double sum = 0.0;
  for (const Observation& sample : samples) {
    sum += squared_error(predicted_reflectance(brdf, sample.geometry), sample, brdf.channels, clip).clipped;
  }
  return sum;
}

struct BothWays {
  Brdf given, estimated;
};

BothWays fit_both_ways(const MaterialModel& model, FitSamples samples, MaterialFitOptions options) {
  options.estimate_error = false;
  BothWays both;
  both.given = fit_brdf(model.brdf, samples, refit_options(model, options)).brdf;
  options.estimate_error = true;
  MaterialModel own{both.given, estimate_error_model(both.given, samples, model.error)};
  own.brdf = fit_brdf(own.brdf, samples, refit_options(own, options)).brdf;
  own.error = estimate_error_model(own.brdf, samples, own.error);
  both.estimated = fit_brdf(own.brdf, samples, refit_options(own, options)).brdf;
  return both;
}

}  // namespace

bool estimated_errors_serve(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                            const MaterialFitOptions& options) {
  LumitexelList learnt, left_out;
  for (std::size_t l = 0; l < lumitexels.size(); ++l) (l % 2 == 0 ? learnt : left_out).push_back(lumitexels[l]);
  const Responsibilities r = responsibilities(mixture, observations, learnt);
  std::vector<BothWays> fits(mixture.materials.size());
  oneapi::tbb::parallel_for(std::size_t{0}, fits.size(), [&](std::size_t k) {
    fits[k] = fit_both_ways(mixture.materials[k], samples_of(observations, learnt, r, k), options);
  });
  const Responsibilities of_left_out = responsibilities(mixture, observations, left_out);
  const double clip = clip_level(observations, lumitexels);
  double sum = 0.0, squares = 0.0;
  for (std::size_t l = 0; l < left_out.size(); ++l) {
    double difference = 0.0;
    for (std::size_t k = 0; k < fits.size(); ++k) {
      const auto samples = observations.of(left_out[l]);
      difference += of_left_out.at(l, k) * (clipped_error(fits[k].estimated, samples, clip) - clipped_error(fits[k].given, samples, clip));
    }
    sum += difference;
    squares += difference * difference;
  }
  return sum <= kStandardErrors * std::sqrt(squares);
}

}  // namespace lumitexel
