#include "processing/brdf/error_choice.h"

#include "processing/brdf/left_out_error.h"

namespace lumitexel {
namespace {

constexpr double kStandardErrors = 2.0, kLeastGain = 0.005;

std::vector<double> values(const std::vector<SquaredError>& errors, double SquaredError::*kind) {
  std::vector<double> all;
  for (const SquaredError& error : errors) all.push_back(error.*kind);
  return all;
}

bool predicts_better(const std::vector<SquaredError>& later, const std::vector<SquaredError>& earlier) {
  const SquaredError scale = total_error(earlier), total = total_error(later);
  // Models that hardly differ do so by chance, and surely: every sample errs a little less.
  if (total.clipped / scale.clipped + total.root / scale.root > 2.0 * (1.0 - kLeastGain)) return false;
  if (excess_in_standard_errors(relative_errors(later, scale), relative_errors(earlier, scale)) >= -kStandardErrors) return false;
  for (const auto kind : {&SquaredError::clipped, &SquaredError::root}) {
    if (excess_in_standard_errors(values(later, kind), values(earlier, kind)) > kStandardErrors) return false;
  }
  return true;
}

}  // namespace

std::size_t best_predictor(const std::vector<const Mixture*>& mixtures, const Observations& observations,
                           const LumitexelList& lumitexels) {
  const double clip = clip_level(observations, lumitexels);
  std::size_t best = 0;
  std::vector<SquaredError> least;
  for (std::size_t i = 0; i < mixtures.size(); ++i) {
    std::vector<SquaredError> errors = left_out_errors(*mixtures[i], observations, lumitexels, clip);
    if (i > 0 && !predicts_better(errors, least)) continue;
    best = i;
    least = std::move(errors);
  }
  return best;
}

}  // namespace lumitexel
