#include "processing/brdf/left_out_photographs.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/lobe_starts.h"
#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

constexpr double kStandardErrors = 1.0;

// Of each photograph that has samples, in order, its place among them.
std::map<std::uint16_t, std::size_t> places(FitSamples samples) {
  std::map<std::uint16_t, std::size_t> place;
  for (const FitSample& sample : samples) place.emplace(sample.view, 0);
  std::size_t next = 0;
  for (auto& entry : place) entry.second = next++;
  return place;
}

Brdf fitted_to(const Brdf& start, FitSamples samples, const ErrorModel& error, const MaterialFitOptions& options) {
  BrdfFitOptions fit = refit_options({start, error}, options);
  fit.brdf_alone = true;
  return fit_brdf(start, samples, fit).brdf;
}

// `smaller`, fitted to these samples, with as many lobes as `richer`, the further ones sought anew: one that only the photographs left out show
// would else stay where they put it, since no other sample sees it. Without them where these samples let none be sought.
Brdf relearnt(const Brdf& richer, const Brdf& smaller, FitSamples samples, const ErrorModel& error, const MaterialFitOptions& options) {
  const std::vector<LobeBounds> bounds = refit_options({richer, error}, options).bounds;
  Brdf start = smaller;
  while (start.lobes.size() < richer.lobes.size()) {
    Brdf grown = with_best_lobe(start, samples, bounds[start.lobes.size()], error);
    if (grown.lobes.size() == start.lobes.size()) break;
    start = std::move(grown);
  }
  return fitted_to(start, samples, error, options);
}

}  // namespace

bool predicts_other_photographs(const MaterialModel& smaller, const MaterialModel& richer, FitSamples samples, const MaterialFitOptions& options) {
  const std::map<std::uint16_t, std::size_t> place = places(samples);
  if (place.size() < 2) return true;
  std::vector<std::vector<FitSample>> photographs(place.size());
  for (const FitSample& sample : samples) photographs[place.at(sample.view)].push_back(sample);
  const ErrorModel& error = options.mean_fit ? *options.mean_fit : richer.error;
  std::vector<double> of_smaller(place.size()), of_richer(place.size());
  for (std::size_t fold = 0; fold < std::min(kPhotographFolds, place.size()); ++fold) {
    std::vector<FitSample> kept;
    for (const FitSample& sample : samples) {
      if (place.at(sample.view) % kPhotographFolds != fold) kept.push_back(sample);
    }
    const Brdf plain = fitted_to(smaller.brdf, kept, error, options), more = relearnt(richer.brdf, plain, kept, error, options);
    for (std::size_t p = fold; p < place.size(); p += kPhotographFolds) {
      of_smaller[p] = misfit(plain, photographs[p], error);
      of_richer[p] = misfit(more, photographs[p], error);
    }
  }
  const PairedDifference gain = paired_difference(of_smaller, of_richer);
  return gain.sum > kStandardErrors * gain.sigma;  // false of what is no number
}

}  // namespace lumitexel
