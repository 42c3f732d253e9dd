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
std::map<std::uint16_t, int> places(FitSamples samples) {
  std::map<std::uint16_t, int> place;
  for (const FitSample& sample : samples) place.emplace(sample.view, 0);
  int next = 0;
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

// Adds to each photograph of `left_out` its misfit.
void add_misfits(const Brdf& brdf, const std::vector<FitSample>& left_out, const std::map<std::uint16_t, int>& place, const ErrorModel& error,
                 std::vector<double>& sums) {
  std::vector<std::vector<FitSample>> by_place(sums.size());
  for (const FitSample& sample : left_out) by_place[static_cast<std::size_t>(place.at(sample.view))].push_back(sample);
  for (std::size_t p = 0; p < sums.size(); ++p) {
    if (!by_place[p].empty()) sums[p] += misfit(brdf, by_place[p], error);
  }
}

}  // namespace

bool predicts_other_photographs(const MaterialModel& smaller, const MaterialModel& richer, FitSamples samples, const MaterialFitOptions& options) {
  const std::map<std::uint16_t, int> place = places(samples);
  if (place.size() < 2) return true;
  const ErrorModel& error = options.mean_fit ? *options.mean_fit : richer.error;
  std::vector<double> of_smaller(place.size()), of_richer(place.size());
  for (int fold = 0; fold < std::min<int>(kPhotographFolds, static_cast<int>(place.size())); ++fold) {
    std::vector<FitSample> kept, left_out;
    for (const FitSample& sample : samples) (place.at(sample.view) % kPhotographFolds == fold ? left_out : kept).push_back(sample);
    const Brdf plain = fitted_to(smaller.brdf, kept, error, options);
    add_misfits(plain, left_out, place, error, of_smaller);
    add_misfits(relearnt(richer.brdf, plain, kept, error, options), left_out, place, error, of_richer);
  }
  const PairedDifference gain = paired_difference(of_smaller, of_richer);
  return gain.sum > kStandardErrors * gain.sigma;  // false of what is no number
}

}  // namespace lumitexel
