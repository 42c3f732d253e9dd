#include "processing/brdf/brdf_slopes.h"

#include <cmath>

namespace lumitexel {

BrdfSlopes::BrdfSlopes(const BrdfParameters& layout, const Eigen::VectorXd& at)
    : layout_(layout), lobes_(static_cast<std::size_t>(layout.lobes())) {
  const LobeFamily& family = layout.family();
  for (int c = 0; c < layout.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    diffuse_[channel] = at[layout.diffuse(c)];
    for (int l = 0; l < layout.lobes(); ++l) {
      const double aim = family.aims ? at[layout.aim(l, c)] : kMirrorAim;
      lobes_[static_cast<std::size_t>(l)][channel] = {family.shape(at[layout.log_shape(l, c)], aim), std::exp(at[layout.log_strength(l, c)])};
    }
  }
}

void BrdfSlopes::predict(const LobeGeometry& geometry, SampleValues& value, SampleSlopes& slope) const {
  value.resize(layout_.channels());
  slope.resize(layout_.channels(), layout_.size());
  const double cos_i = geometry.cos_i;
  slope.setZero();
  for (int c = 0; c < layout_.channels(); ++c) {
    value[c] = cos_i * diffuse_[static_cast<std::size_t>(c)];
    slope(c, layout_.diffuse(c)) = cos_i;
  }
  const LobeFamily& family = layout_.family();
  for (int l = 0; l < layout_.lobes(); ++l) {
    LobeSlopes terms;
    for (int c = 0; c < layout_.channels(); ++c) {
      const ChannelLobe& lobe = lobes_[static_cast<std::size_t>(l)][static_cast<std::size_t>(c)];
      if (c == 0 || !layout_.shared_shape()) terms = family.slopes_of(lobe.shape, geometry);
      const double strength = cos_i * lobe.strength;
      value[c] += strength * terms.gain + cos_i * terms.offset;
      slope(c, layout_.log_strength(l, c)) = strength * terms.gain;
      slope(c, layout_.log_shape(l, c)) = strength * terms.gain_by_shape + cos_i * terms.offset_by_shape;
      if (family.aims) slope(c, layout_.aim(l, c)) = strength * terms.gain_by_aim;
    }
  }
}

}  // namespace lumitexel
