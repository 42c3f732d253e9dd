#include "processing/brdf/choose_bases.h"

#include "processing/brdf/material_basis.h"

namespace lumitexel {

BasesChoice choose_bases(const Observations& observations, const std::vector<std::size_t>& members, const std::vector<Brdf>& basis,
                         const ErrorModel& error, Precision precision) {
  const auto with = [&](std::size_t bases) {
    const std::vector<Brdf> own(basis.begin(), basis.begin() + static_cast<std::ptrdiff_t>(bases));
    return BasesChoice{bases, choose_prior(observations, members, TexelBasis(own, basis[0], error, precision)), std::nullopt};
  };
  BasesChoice all = with(basis.size());
  constexpr std::size_t kOwn = 1 + kVariations;
  if (basis.size() <= kOwn) return all;
  BasesChoice own = with(kOwn);
  all.gain = own.gain = gain_of(all.prior.by_texel, own.prior.by_texel);
  return worth_having(*all.gain) ? all : own;
}

}  // namespace lumitexel
