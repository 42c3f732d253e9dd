#include "processing/brdf/choose_bases.h"

#include "processing/brdf/left_out_error.h"
#include "processing/brdf/material_basis.h"

namespace lumitexel {

BasesChoice choose_bases(const Observations& observations, const std::vector<std::size_t>& members, const std::vector<Brdf>& basis,
                         const ErrorModel& error, Precision precision) {
  const auto with = [&](std::size_t bases) {
    const std::vector<Brdf> own(basis.begin(), basis.begin() + static_cast<std::ptrdiff_t>(bases));
    return BasesChoice{bases, choose_prior(observations, members, TexelBasis(own, basis[0], error, precision))};
  };
  BasesChoice all = with(basis.size());
  constexpr std::size_t kOwn = 1 + kVariations;
  if (basis.size() <= kOwn) return all;
  BasesChoice own = with(kOwn);
  constexpr double kStandardErrors = 2.0;
  const bool worth = all.prior.left_out_error < (1.0 - kLeastBasisGain) * own.prior.left_out_error;
  return worth && excess_in_standard_errors(all.prior.by_texel, own.prior.by_texel) < -kStandardErrors ? all : own;
}

}  // namespace lumitexel
