#include "processing/brdf/error_choice.h"

#include "processing/brdf/left_out_error.h"

namespace lumitexel {
namespace {

constexpr double kStandardErrors = 2.0, kShare = 0.005, kMostLoss = 0.02;

std::vector<double> values(const std::vector<SquaredError>& errors, double SquaredError::*kind) {
  std::vector<double> all;
  for (const SquaredError& error : errors) all.push_back(error.*kind);
  return all;
}

bool predicts_better(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  const SquaredError scale = total_error(earlier);
  if (excess_in_standard_errors(relative_errors(later, scale), relative_errors(earlier, scale)) >= -kStandardErrors) return false;
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    if (excess_in_standard_errors(values(later, kind), values(earlier, kind)) > kStandardErrors) return false;
  }
  return true;
}

bool gains_a_share(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  const SquaredError before = total_error(earlier), after = total_error(later);
  return after.clipped / before.clipped + after.root / before.root <= 2.0 * (1.0 - kShare);
}

bool loses_little(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    const bool little = total_error(later).*kind <= (1.0 + kMostLoss) * total_error(earlier).*kind;
    if (!little) return false;  // nor what is no number
    std::vector<double> allowed = values(earlier, kind);
    for (double& value : allowed) value *= 1.0 + kShare;
    if (excess_in_standard_errors(values(later, kind), allowed) > kStandardErrors) return false;
  }
  return true;
}

bool holds(Claim claim, const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  switch (claim) {
    case Claim::Richer: return gains_a_share(later, earlier) && predicts_better(later, earlier);
    case Claim::Efficient: return loses_little(later, earlier) || predicts_better(later, earlier);
    case Claim::Better: break;
  }
  return predicts_better(later, earlier);
}

}  // namespace

std::size_t best_predictor(const std::vector<const Mixture*>& mixtures, const Observations& observations, const LumitexelList& lumitexels,
                           Claim claim) {
  const double clip = clip_level(observations, lumitexels);
  std::size_t best = 0;
  std::vector<SquaredError> least;
  for (std::size_t i = 0; i < mixtures.size(); ++i) {
    std::vector<SquaredError> errors = left_out_errors(*mixtures[i], observations, lumitexels, clip);
    if (i > 0 && !holds(claim, errors, least)) continue;
    best = i;
    least = std::move(errors);
  }
  return best;
}

}  // namespace lumitexel
