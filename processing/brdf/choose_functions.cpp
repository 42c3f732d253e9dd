#include "processing/brdf/choose_functions.h"

namespace lumitexel {

FunctionsChoice choose_functions(const Observations& observations, const LumitexelList& members, const std::vector<Brdf>& basis,
                                 const MaterialModel& material, const PrincipalOptions& options, Precision precision) {
  LumitexelList learnt, left_out;
  for (std::size_t k = 0; k < members.size(); ++k) (k % 2 == 0 ? learnt : left_out).push_back(members[k]);
  const auto errors_with = [&](const std::vector<Brdf>& functions) {
    return choose_prior(observations, left_out, TexelBasis(functions, material.brdf, material.error, precision)).by_texel;
  };
  const std::vector<Brdf> moved = principal_functions(observations, learnt, basis, material.error, options).basis;
  const Gain gain = gain_of(errors_with(moved), errors_with(basis));
  return {worth_having(gain), gain};
}

}  // namespace lumitexel
