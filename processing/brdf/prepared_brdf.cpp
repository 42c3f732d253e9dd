#include "processing/brdf/prepared_brdf.h"

#include <cmath>

namespace lumitexel {

PreparedBrdf::PreparedBrdf(const Brdf& brdf)
    : family_(&lobe_family(brdf.family)), channels_(brdf.channels), diffuse_(brdf.diffuse), lobes_(brdf.lobes.size()) {
  for (std::size_t l = 0; l < lobes_.size(); ++l) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
      const Lobe& lobe = brdf.lobes[l][c];
      lobes_[l][c] = {family_->shape(lobe.log_shape, lobe.aim), std::exp(lobe.log_strength),
                      lobe.log_strength == -std::numeric_limits<double>::infinity(), c > 0 && lobe.same_shape(brdf.lobes[l][c - 1])};
    }
  }
}

ChannelValues PreparedBrdf::value(const LobeGeometry& geometry) const {
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return {};
  ChannelValues values = diffuse_;
  for (const auto& lobe : lobes_) {
    LobeTerms terms;
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
      if (!lobe[c].like_before) terms = family_->terms_of(lobe[c].shape, geometry);
      if (!lobe[c].off) values[c] += lobe[c].strength * terms.gain + terms.offset;
    }
  }
  return values;
}

ChannelValues predicted_reflectance(const std::vector<PreparedBrdf>& basis, const std::vector<float>& weight, const LobeGeometry& geometry) {
  ChannelValues sum{};
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (weight[k] == 0.0f) continue;
    const ChannelValues values = predicted_reflectance(basis[k], geometry);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += static_cast<double>(weight[k]) * values[c];
  }
  return sum;
}

}  // namespace lumitexel
