#include "processing/brdf/error_choice.h"

#include <cmath>

namespace lumitexel {
namespace {

constexpr double kStandardErrors = 2.0, kShare = 0.005, kMostLoss = 0.02;

std::vector<double> values(const std::vector<SquaredError>& errors, double SquaredError::*kind) {
  std::vector<double> all;
  for (const SquaredError& error : errors) all.push_back(error.*kind);
  return all;
}

// Of both kinds of error, each a share of the earlier one's.
Gain gain(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  const SquaredError scale = total_error(earlier);
  return gain_of(relative_errors(later, scale), relative_errors(earlier, scale));
}

bool predicts_better(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  const Gain both = gain(later, earlier);
  if (!(both.share > kStandardErrors * both.sigma)) return false;
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    if (excess_in_standard_errors(values(later, kind), values(earlier, kind)) > kStandardErrors) return false;
  }
  return true;
}

bool loses_little(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    if (total_error(later).*kind > (1.0 + kMostLoss) * total_error(earlier).*kind) return false;
    std::vector<double> allowed = values(earlier, kind);
    for (double& value : allowed) value *= 1.0 + kShare;
    if (excess_in_standard_errors(values(later, kind), allowed) > kStandardErrors) return false;
  }
  return true;
}

bool is_number(const std::vector<SquaredError>& errors) {
  const SquaredError total = total_error(errors);
  return std::isfinite(total.clipped) && std::isfinite(total.root);
}

bool holds(Claim claim, const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  if (!is_number(later)) return false;
  if (!is_number(earlier)) return true;
  switch (claim) {
    case Claim::Richer: return gain(later, earlier).share >= kShare && predicts_better(later, earlier);
    case Claim::Efficient: return loses_little(later, earlier) || predicts_better(later, earlier);
    case Claim::Better: break;
  }
  return predicts_better(later, earlier);
}

}  // namespace

std::size_t best_predictor(const std::string& of, const std::vector<Predictor>& predictors, Claim claim, std::vector<Choice>& choices) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < predictors.size(); ++i) {
    const std::vector<SquaredError>&later = *predictors[i].errors, &earlier = *predictors[best].errors;
    const bool taken = holds(claim, later, earlier);
    choices.push_back({of, predictors[i].name, predictors[best].name, gain(later, earlier), taken});
    if (taken) best = i;
  }
  return best;
}

}  // namespace lumitexel
