#include "processing/brdf/error_choice.h"

#include <cmath>

namespace lumitexel {
namespace {

constexpr double kMostLoss = 0.02;

std::vector<double> values(const std::vector<SquaredError>& errors, double SquaredError::*kind) {
  std::vector<double> all;
  for (const SquaredError& error : errors) all.push_back(error.*kind);
  return all;
}

// Of both kinds of error, each a share of the earlier one's.
Gain gain(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier, Judges judges) {
  const SquaredError scale = total_error(earlier);
  return gain_of(relative_errors(later, scale), relative_errors(earlier, scale), judges);
}

// of_both: the gain in the sum of the two kinds.
bool predicts_better(const Gain& of_both, const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier, Judges judges) {
  if (!is_sure(of_both)) return false;
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    if (excess_in_standard_errors(values(later, kind), values(earlier, kind), judges) > kGainStandardErrors) return false;
  }
  return true;
}

bool loses_little(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier, Judges judges) {
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    if (total_error(later).*kind > (1.0 + kMostLoss) * total_error(earlier).*kind) return false;
    std::vector<double> allowed = values(earlier, kind);
    for (double& value : allowed) value *= 1.0 + kLeastGainShare;
    if (excess_in_standard_errors(values(later, kind), allowed, judges) > kGainStandardErrors) return false;
  }
  return true;
}

bool is_number(const std::vector<SquaredError>& errors) {
  const SquaredError total = total_error(errors);
  return std::isfinite(total.clipped) && std::isfinite(total.root);
}

bool holds(Claim claim, const Gain& of_both, const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier, Judges judges) {
  if (!is_number(later)) return false;
  if (!is_number(earlier)) return true;
  switch (claim) {
    case Claim::Richer: return worth_having(of_both) && predicts_better(of_both, later, earlier, judges);
    case Claim::Efficient: return loses_little(later, earlier, judges) || predicts_better(of_both, later, earlier, judges);
    case Claim::Better: break;
  }
  return predicts_better(of_both, later, earlier, judges);
}

}  // namespace

std::size_t best_predictor(const std::string& of, const std::vector<Predictor>& predictors, Claim claim, std::vector<Choice>& choices, Judges judges) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < predictors.size(); ++i) {
    const std::vector<SquaredError>&later = *predictors[i].errors, &earlier = *predictors[best].errors;
    const Gain of_both = gain(later, earlier, judges);
    const bool taken = holds(claim, of_both, later, earlier, judges);
    choices.push_back({of, predictors[i].name, predictors[best].name, of_both, taken});
    if (taken) best = i;
  }
  return best;
}

}  // namespace lumitexel
