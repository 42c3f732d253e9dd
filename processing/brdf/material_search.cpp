#include "processing/brdf/material_search.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "processing/brdf/error_choice.h"
#include "processing/brdf/merge_materials.h"
#include "processing/brdf/split_materials.h"

namespace lumitexel {
namespace {

constexpr int kSearchRounds = 24, kMeanRounds = 8;  // of expectation-maximisation
constexpr double kSearchSettled = 1e-4;             // of log likelihood a sample and round
constexpr int kMostExtra = 8;                       // materials beyond those wanted that splitting may make

// While materials are told apart they all have a lobe: what a matte whole hides, a part may show.
MaterialSearch search_with(ErrorSource errors, const Observations& observations, const LumitexelList& selection,
                           const ClusterOptions& options, const std::function<void(int)>& report) {
  const int wanted = options.materials > 0 ? options.materials : kMostMaterials;
  const int most = wanted == 1 ? 1 : std::min(2 * wanted, wanted + kMostExtra);
  MaterialSearch search{errors, options.fit, {}};
  search.fit.choose_lobes = false;
  search.fit.most_lobes = std::min(1, options.fit.most_lobes);
  search.fit.estimate_error = errors != ErrorSource::Given;
  const MaterialFit whole = fit_material(samples_of(observations, selection), observations.channels, nullptr, search.fit);
  search.mixture = split_materials(whole, observations, selection, most, search.fit);
  maximise_expectation(search.mixture, observations, selection, search.fit, {kSearchRounds, kSearchSettled});
  merge_materials(search.mixture, observations, selection, {options.materials, search.fit}, report);
  return search;
}

// The materials that estimated errors told apart, each with the best mean prediction for a BRDF.
MaterialSearch with_mean_fits(MaterialSearch search, const Observations& observations, const LumitexelList& selection,
                              const ClusterOptions& options) {
  search.errors = ErrorSource::Labels;
  search.fit.mean_fit = options.fit.error;
  std::vector<BrdfFit> fits;
  const Responsibilities r = responsibilities(search.mixture, observations, selection);
  choose_lobes(search.mixture, observations, selection, r, search.fit, fits);
  maximise_expectation(search.mixture, observations, selection, search.fit, {kMeanRounds, kSearchSettled});
  return search;
}

}  // namespace

void choose_lobes(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                  const MaterialFitOptions& options, std::vector<BrdfFit>& fits) {
  fits.resize(mixture.materials.size());
  oneapi::tbb::parallel_for(std::size_t{0}, mixture.materials.size(), [&](std::size_t k) {
    MaterialFitOptions own = options;
    own.error = mixture.materials[k].error;
    const auto samples = samples_of(observations, lumitexels, r, k);
    const MaterialFit fit = fit_material(samples, observations.channels, &mixture.materials[k].brdf, own);
    mixture.materials[k] = fit.model;
    fits[k] = fit.fit;
  });
}

MaterialSearch search_for_materials(const Observations& observations, const LumitexelList& selection, const ClusterOptions& options,
                                    const std::function<void(int)>& report) {
  if (options.errors == ErrorSource::Given) return search_with(ErrorSource::Given, observations, selection, options, report);
  MaterialSearch estimated = search_with(ErrorSource::Estimated, observations, selection, options, report);
  if (options.errors == ErrorSource::Estimated) return estimated;
  MaterialSearch mean = with_mean_fits(estimated, observations, selection, options);
  if (options.errors == ErrorSource::Labels) return mean;
  MaterialSearch given = search_with(ErrorSource::Given, observations, selection, options, report);
  const std::vector<MaterialSearch*> searches{&given, &mean, &estimated};
  return *searches[best_predictor({&given.mixture, &mean.mixture, &estimated.mixture}, observations, selection)];
}

}  // namespace lumitexel
