#include "processing/brdf/brdf_slopes.h"

#include <cmath>

namespace lumitexel {

void predict_with_slopes(const BrdfParameters& layout, const Eigen::VectorXd& at, const LobeGeometry& geometry, SampleValues& value,
                         SampleSlopes& slope) {
  value.resize(layout.channels());
  slope.resize(layout.channels(), layout.size());
  const double cos_i = geometry.cos_i;
  slope.setZero();
  for (int c = 0; c < layout.channels(); ++c) {
    value[c] = cos_i * at[layout.diffuse(c)];
    slope(c, layout.diffuse(c)) = cos_i;
  }
  const LobeFamily& family = layout.family();
  for (int l = 0; l < layout.lobes(); ++l) {
    LobeSlopes terms;
    for (int c = 0; c < layout.channels(); ++c) {
      const int shape = layout.log_shape(l, c), aim = layout.aim(l, c);
      if (c == 0 || !layout.shared_shape()) terms = family.slopes(at[shape], family.aims ? at[aim] : kMirrorAim, geometry);
      const double strength = cos_i * std::exp(at[layout.log_strength(l, c)]);
      value[c] += strength * terms.gain + cos_i * terms.offset;
      slope(c, layout.log_strength(l, c)) = strength * terms.gain;
      slope(c, shape) = strength * terms.gain_by_shape + cos_i * terms.offset_by_shape;
      if (family.aims) slope(c, aim) = strength * terms.gain_by_aim;
    }
  }
}

}  // namespace lumitexel
