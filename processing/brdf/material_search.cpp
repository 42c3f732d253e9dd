#include "processing/brdf/material_search.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <iterator>

#include "processing/brdf/choose_materials.h"
#include "processing/brdf/error_choice.h"
#include "processing/brdf/merge_materials.h"
#include "processing/brdf/select_lumitexels.h"
#include "processing/brdf/split_materials.h"

namespace lumitexel {
namespace {

constexpr int kSearchRounds = 24, kRefitRounds = 8;  // of expectation-maximisation
constexpr double kSearchSettled = 1e-4;              // of log likelihood a sample and round
constexpr std::size_t kMostJudges = 20'000;         // lumitexels: ten times as many as the presets but reference learn from
constexpr const char *kMaterials = "materials", *kErrors = "errors", *kFamily = "family", *kLobeShapes = "lobe shapes";  // as choices are called
constexpr int kMostExtra = 8;                        // materials beyond those wanted that splitting may make
constexpr int kStepsBesideMaterials = 2;             // of a search from nothing: the first fit, and what follows the last merge

// Who have not learnt; where they are fewer than the learners, and most that came near a mirror reflection among these, the learners themselves.
LumitexelList judges(const Observations& observations, const LumitexelList& selection) {
  const LumitexelList usable = with_samples(observations, kFewestSamples);
  LumitexelList others;
  std::set_difference(usable.begin(), usable.end(), selection.begin(), selection.end(), std::back_inserter(others));
  return others.size() < selection.size() ? selection : thinned(others, kMostJudges);
}

// That splitting makes.
int most_materials(const ClusterOptions& options) {
  const int wanted = options.materials > 0 ? options.materials : kMostMaterials;
  return wanted == 1 ? 1 : std::min(2 * wanted, wanted + kMostExtra);
}

// Of one search: splits up to the most materials, merges down from them, and chooses among their numbers.
int steps_from_nothing(const ClusterOptions& options) {
  return 2 * most_materials(options) + (options.materials == 0 ? kChoosingSteps : 0) + kStepsBesideMaterials;
}

// While materials are told apart they all have a lobe: what a matte whole hides, a part may show.
MaterialSearch search_with(ErrorSource errors, const Observations& observations, const LumitexelList& selection,
                           const ClusterOptions& options, const std::function<void(int)>& report) {
  const int most = most_materials(options);
  MaterialSearch search;
  search.errors = errors;
  search.fit = options.fit;
  search.fit.choose_lobes = false;
  search.fit.most_lobes = std::min(1, options.fit.most_lobes);
  search.fit.estimate_error = errors != ErrorSource::Given;
  search.fit.shared_shape = options.lobe_shapes != LobeShapes::Separate;
  const MaterialFit whole = fit_material(samples_of(observations, selection), observations.channels, nullptr, search.fit);
  report(1);
  search.mixture = split_materials(whole, observations, selection, most, search.fit, [&](int parts) { report(1 + parts); });
  report(1 + most);
  maximise_expectation(search.mixture, observations, selection, search.fit, {kSearchRounds, kSearchSettled});
  search.choices = merge_materials(search.mixture, observations, selection, {options.materials, search.fit, judges(observations, selection)},
                                   [&](int left) { report(steps_from_nothing(options) - 1 - left); });
  report(steps_from_nothing(options));
  return search;
}

// The same materials after search.fit has changed: fitted as it says now, then settled.
void refit(MaterialSearch& search, const Observations& observations, const LumitexelList& selection) {
  std::vector<BrdfFit> fits;
  const Responsibilities r = responsibilities(search.mixture, observations, selection);
  choose_lobes(search.mixture, observations, selection, r, search.fit, fits);
  maximise_expectation(search.mixture, observations, selection, search.fit, {kRefitRounds, kSearchSettled});
  search.left_out.clear();
}

// The materials that estimated errors told apart, each with the best mean prediction for a BRDF.
MaterialSearch with_mean_fits(MaterialSearch search, const Observations& observations, const LumitexelList& selection,
                              const ClusterOptions& options) {
  search.errors = ErrorSource::Labels;
  search.fit.mean_fit = options.fit.error;
  refit(search, observations, selection);
  return search;
}

// The lobes that materials known before have already: both are asked for theirs before they are compared.
void give_lobes(MaterialSearch& search, const Observations& observations, const LumitexelList& selection, const ClusterOptions& options) {
  if (search.fit.most_lobes == options.fit.most_lobes) return;
  search.fit.most_lobes = options.fit.most_lobes;
  search.fit.choose_lobes = options.fit.choose_lobes;
  refit(search, observations, selection);
}

// The number of materials and what they are fitted by stay.
MaterialSearch adapted(const Clustering& before, const Observations& observations, const LumitexelList& selection, const ClusterOptions& options) {
  MaterialSearch search;
  search.known_before = true;
  search.errors = before.errors;
  search.fit = options.fit;
  search.fit.estimate_error = before.fit.estimate_error;
  if (before.fit.mean_fit) search.fit.mean_fit = options.fit.error;
  search.fit.family = before.fit.family;
  search.fit.shared_shape = before.fit.shared_shape;
  double members = 0.0;
  for (const FittedMaterial& material : before.materials) members += static_cast<double>(material.members);
  for (const FittedMaterial& material : before.materials) {
    search.mixture.materials.push_back({material.model.brdf, search.fit.estimate_error ? material.model.error : options.fit.error});
    search.mixture.share.push_back(std::max(static_cast<double>(material.members), 1.0) / members);
  }
  maximise_expectation(search.mixture, observations, selection, search.fit, {kSearchRounds, kSearchSettled});
  return search;
}

// Of searches that differ in `of`, each called by what `name_of` says of it.
template <typename Name>
MaterialSearch best_of(const std::string& of, std::vector<MaterialSearch> searches, Name name_of, const Observations& observations,
                       const LumitexelList& selection, Claim claim) {
  if (searches.size() == 1) return std::move(searches.front());
  const LumitexelList asked = judges(observations, selection);
  const double clip = clip_level(observations, asked);
  std::vector<Predictor> predictors;
  for (MaterialSearch& search : searches) {
    if (search.left_out.empty()) search.left_out = left_out_errors(search.mixture, observations, asked, clip);
    predictors.push_back({name_of(search), &search.left_out});
  }
  std::vector<Choice> choices;
  MaterialSearch best = std::move(searches[best_predictor(of, predictors, claim, choices)]);
  best.choices.insert(best.choices.end(), choices.begin(), choices.end());
  return best;
}

const char* errors_of(const MaterialSearch& search) { return to_string(search.errors); }
const char* family_of(const MaterialSearch& search) { return to_string(search.fit.family); }
const char* origin_of(const MaterialSearch& search) { return search.known_before ? "known before" : "found anew"; }
const char* shapes_of(const MaterialSearch& search) { return to_string(search.fit.shared_shape ? LobeShapes::Shared : LobeShapes::Separate); }

// From nothing.
MaterialSearch found_anew(const Observations& observations, const LumitexelList& selection, const ClusterOptions& options,
                          const std::function<void(int)>& report) {
  int before = 0;
  const auto search = [&](ErrorSource errors) {
    MaterialSearch found = search_with(errors, observations, selection, options, [&](int steps) { report(before + steps); });
    before += steps_from_nothing(options);
    return found;
  };
  if (options.errors == ErrorSource::Given || options.errors == ErrorSource::Estimated) return search(options.errors);
  MaterialSearch estimated = search(ErrorSource::Estimated), labels = with_mean_fits(estimated, observations, selection, options);
  if (options.errors == ErrorSource::Labels) return labels;
  MaterialSearch cautious = best_of(kErrors, {search(ErrorSource::Given), std::move(labels)}, errors_of, observations, selection, Claim::Better);
  // Labels and estimates tell the same materials apart.
  const Claim claim = cautious.errors == ErrorSource::Labels ? Claim::Efficient : Claim::Better;
  std::copy_if(cautious.choices.begin(), cautious.choices.end(), std::back_inserter(estimated.choices),
               [](const Choice& choice) { return choice.of == kErrors; });
  return best_of(kErrors, {std::move(cautious), std::move(estimated)}, errors_of, observations, selection, claim);
}

MaterialSearch with_family(MaterialSearch search, BrdfFamily family, const Observations& observations, const LumitexelList& selection) {
  search.fit.family = family;
  refit(search, observations, selection);
  return search;
}

MaterialSearch with_separate_shapes(MaterialSearch search, const Observations& observations, const LumitexelList& selection) {
  search.fit.shared_shape = false;
  refit(search, observations, selection);
  return search;
}

// Each richer choice against the one before it: first whose lobes, then how many shapes.
MaterialSearch with_lobes_asked_for(MaterialSearch search, const Observations& observations, const LumitexelList& selection,
                                    const ClusterOptions& options) {
  if (options.fit.most_lobes == 0) return search;
  if (options.any_family) {
    std::vector<MaterialSearch> families{std::move(search)};
    for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) {
      if (family != families.front().fit.family) families.push_back(with_family(families.front(), family, observations, selection));
    }
    search = best_of(kFamily, std::move(families), family_of, observations, selection, Claim::Richer);
  }
  if (options.lobe_shapes == LobeShapes::Auto && search.fit.shared_shape && observations.channels > 1) {
    std::vector<MaterialSearch> shapes{std::move(search)};
    shapes.push_back(with_separate_shapes(shapes.front(), observations, selection));
    search = best_of(kLobeShapes, std::move(shapes), shapes_of, observations, selection, Claim::Richer);
  }
  return search;
}

}  // namespace

int search_steps(const ClusterOptions& options) {
  if (options.before.clustering != nullptr && !options.before.anew) return 0;
  const bool by_both_errors = options.errors == ErrorSource::Auto;
  return (by_both_errors ? 2 : 1) * steps_from_nothing(options);
}

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
  std::vector<MaterialSearch> searches;
  if (options.before.clustering != nullptr) searches.push_back(adapted(*options.before.clustering, observations, selection, options));
  if (searches.empty() || options.before.anew) {
    MaterialSearch anew = found_anew(observations, selection, options, report);
    if (!searches.empty()) give_lobes(anew, observations, selection, options);
    searches.push_back(std::move(anew));
  }
  MaterialSearch best = best_of(kMaterials, std::move(searches), origin_of, observations, selection, Claim::Richer);
  const bool known = options.before.clustering != nullptr && !options.before.anew;
  return known ? best : with_lobes_asked_for(std::move(best), observations, selection, options);
}

}  // namespace lumitexel
