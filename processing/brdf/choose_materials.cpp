#include "processing/brdf/choose_materials.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "processing/brdf/error_choice.h"
#include "processing/brdf/projected_error.h"

namespace lumitexel {
namespace {

constexpr const char* kNumber = "number of materials";
constexpr std::size_t kMostAsked = 5000;  // judges: each is projected four times for every candidate

// Of a chain of comparisons, those that a reader needs.
std::vector<Choice> last_taken_and_nearest_refused(const std::vector<Choice>& choices) {
  std::vector<Choice> kept;
  const auto after = std::find_if(choices.rbegin(), choices.rend(), [](const Choice& choice) { return choice.taken; }).base();
  if (after != choices.begin()) kept.push_back(*std::prev(after));
  if (after != choices.end()) kept.push_back(*after);
  return kept;
}

}  // namespace

ChosenMaterials choose_materials(const std::vector<Mixture>& candidates, Presumed presumed, const Observations& observations,
                                 const LumitexelList& learners, const LumitexelList& judges) {
  if (candidates.size() < 2) return {};
  const LumitexelList asked = thinned(judges, kMostAsked);
  const double clip = clip_level(observations, asked);
  std::vector<std::vector<SquaredError>> errors;
  for (const Mixture& mixture : candidates) errors.push_back(projected_errors(mixture, observations, learners, asked, clip));
  std::vector<Predictor> predictors;
  for (std::size_t i = 0; i < candidates.size(); ++i) predictors.push_back({std::to_string(candidates[i].materials.size()), &errors[i]});
  if (presumed == Presumed::Few) std::reverse(predictors.begin(), predictors.end());
  std::vector<Choice> choices;
  const std::size_t best = best_predictor(kNumber, predictors, Claim::Richer, choices);
  return {presumed == Presumed::Few ? candidates.size() - 1 - best : best, last_taken_and_nearest_refused(choices)};
}

}  // namespace lumitexel
