#include "processing/brdf/choose_materials.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "processing/brdf/error_choice.h"
#include "processing/brdf/left_out_folds.h"
#include "processing/brdf/projected_error.h"

namespace lumitexel {
namespace {

constexpr const char *kNumber = "number of materials", *kNumberByPhotographs = "number of materials, by photographs";
constexpr std::size_t kMostAsked = 5000;  // judges: each is projected four times for every candidate

constexpr std::size_t kFolds = 4;            // of photographs
constexpr std::size_t kMostRelearnt = 5000;   // learners that materials are learnt again from: what tells numbers apart, so many do
constexpr int kRounds = 6;                    // of expectation-maximisation, without the photographs left out
constexpr double kSettled = 1e-4;
constexpr double kNextSize = 1.25;            // between two numbers that photographs are asked about

// Of a chain of comparisons, those that a reader needs.
std::vector<Choice> last_taken_and_nearest_refused(const std::vector<Choice>& choices) {
  std::vector<Choice> kept;
  const auto after = std::find_if(choices.rbegin(), choices.rend(), [](const Choice& choice) { return choice.taken; }).base();
  if (after != choices.begin()) kept.push_back(*std::prev(after));
  if (after != choices.end()) kept.push_back(*after);
  return kept;
}

int steps_left(std::size_t asked, std::size_t of) { return static_cast<int>((of - asked) * kChoosingSteps / of); }

using ErrorsByCandidate = std::vector<std::vector<SquaredError>>;

// The places of `some` in `all`, both ascending.
LumitexelList places_of(const LumitexelList& some, const LumitexelList& all) {
  LumitexelList places;
  for (const std::size_t l : some) places.push_back(static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), l) - all.begin()));
  return places;
}

LumitexelList with_samples_in(const Observations& observations, const LumitexelList& list) {
  LumitexelList some;
  std::copy_if(list.begin(), list.end(), std::back_inserter(some), [&](std::size_t l) { return !observations.of(l).empty(); });
  return some;
}

// From what is shown alone. A lobe that only the photographs left out show would else stay where they put it, since no other sample sees it.
Mixture relearnt(Mixture mixture, const Observations& shown, const LumitexelList& learners, const MaterialFitOptions& fit) {
  const Responsibilities r = responsibilities(mixture, shown, learners);
  oneapi::tbb::parallel_for(std::size_t{0}, mixture.materials.size(), [&](std::size_t k) {
    MaterialFitOptions own = fit;
    own.error = mixture.materials[k].error;
    mixture.materials[k] = fit_material(samples_of(shown, learners, r, k), shown.channels, nullptr, own).model;
  });
  maximise_expectation(mixture, shown, learners, fit, {kRounds, kSettled, false});
  return mixture;
}

ErrorsByCandidate errors_by_photograph(const std::vector<Mixture>& candidates, const Observations& observations, const LumitexelList& learners,
                                       const LumitexelList& asked, const MaterialFitOptions& fit, double clip, const std::function<void(int)>& report) {
  LumitexelList all;
  std::set_union(learners.begin(), learners.end(), asked.begin(), asked.end(), std::back_inserter(all));
  const LumitexelList all_learners = places_of(learners, all), all_asked = places_of(asked, all);
  const std::size_t photographs = 1 + *std::max_element(observations.view.begin(), observations.view.end());
  ErrorsByCandidate errors(candidates.size(), std::vector<SquaredError>(photographs));
  const std::size_t asks = kFolds * candidates.size();
  for (std::size_t f = 0; f < kFolds; ++f) {
    const PhotographFold fold = photograph_fold(observations, all, f, kFolds);
    const LumitexelList own = with_samples_in(fold.shown, all_learners);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const Mixture mixture = relearnt(candidates[c], fold.shown, own, fit);
      const auto of_fold = projected_errors_by_photograph(mixture, fold, own, all_asked, photographs, clip);
      for (std::size_t v = 0; v < photographs; ++v) errors[c][v] += of_fold[v];
      report(steps_left(f * candidates.size() + c + 1, asks));
    }
  }
  return errors;
}

// From few to many, and none so near another that it would say the same.
std::vector<std::size_t> spaced_sizes(const std::vector<Mixture>& candidates) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = candidates.size(); i-- > 0;) {
    const bool farther = chosen.empty() || static_cast<double>(candidates[i].materials.size()) >= kNextSize * static_cast<double>(candidates[chosen.back()].materials.size());
    if (farther || i == 0) chosen.push_back(i);
  }
  return chosen;
}

ChosenMaterials choose_by_photographs(const std::vector<Mixture>& candidates, const Observations& observations, const LumitexelList& learners,
                                      const LumitexelList& asked, const MaterialFitOptions& fit, double clip,
                                      const std::function<void(int)>& report) {
  const std::vector<std::size_t> sizes = spaced_sizes(candidates);
  std::vector<Mixture> spaced;
  for (const std::size_t i : sizes) spaced.push_back(candidates[i]);
  const ErrorsByCandidate errors = errors_by_photograph(spaced, observations, thinned(learners, kMostRelearnt), asked, fit, clip, report);
  std::vector<Predictor> predictors;
  for (std::size_t i = 0; i < spaced.size(); ++i) predictors.push_back({std::to_string(spaced[i].materials.size()), &errors[i]});
  std::vector<Choice> choices;
  const std::size_t best = best_predictor(kNumberByPhotographs, predictors, Claim::Richer, choices, Judges::Photographs);
  return {sizes[best], last_taken_and_nearest_refused(choices)};
}

}  // namespace

ChosenMaterials choose_materials(const std::vector<Mixture>& candidates, Presumed presumed, const Observations& observations,
                                 const LumitexelList& learners, const LumitexelList& judges, const MaterialFitOptions& fit,
                                 const std::function<void(int)>& report) {
  if (candidates.size() < 2) return {};
  const LumitexelList asked = thinned(judges, kMostAsked);
  const double clip = clip_level(observations, asked);
  if (photographs_of(observations, learners) >= kFewestPhotographs) {
    return choose_by_photographs(candidates, observations, learners, asked, fit, clip, report);
  }
  ErrorsByCandidate errors;
  for (const Mixture& mixture : candidates) {
    errors.push_back(projected_errors(mixture, observations, learners, asked, clip));
    report(steps_left(errors.size(), candidates.size()));
  }
  std::vector<Predictor> predictors;
  for (std::size_t i = 0; i < candidates.size(); ++i) predictors.push_back({std::to_string(candidates[i].materials.size()), &errors[i]});
  if (presumed == Presumed::Few) std::reverse(predictors.begin(), predictors.end());
  std::vector<Choice> choices;
  const std::size_t best = best_predictor(kNumber, predictors, Claim::Richer, choices);
  return {presumed == Presumed::Few ? candidates.size() - 1 - best : best, last_taken_and_nearest_refused(choices)};
}

}  // namespace lumitexel
