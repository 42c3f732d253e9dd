#include "processing/brdf/error_choice.h"

#include "processing/brdf/left_out_error.h"

namespace lumitexel {

bool estimated_errors_serve(const Mixture& given, const Mixture& estimated, const Observations& observations,
                            const LumitexelList& lumitexels) {
  constexpr double kStandardErrors = 2.0;
  const double clip = clip_level(observations, lumitexels);
  const auto of_given = left_out_errors(given, observations, lumitexels, clip);
  const auto of_estimated = left_out_errors(estimated, observations, lumitexels, clip);
  const SquaredError total = total_error(of_given);
  return excess_in_standard_errors(relative_errors(of_estimated, total), relative_errors(of_given, total)) < -kStandardErrors;
}

}  // namespace lumitexel
