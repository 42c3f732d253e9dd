// What a family of reflectance lobes has to say about itself, so that one fit serves all. One file a family.
//
//   lafortune.cpp   A D^N:       strength A (1/sr, the value at the peak), shape N, aim phi
//   ggx.cpp         microfacets: strength F0 (reflectance at normal incidence), shape alpha
//   ward.cpp        Gaussian of the half vector: strength rho_s (albedo, about), shape alpha
#pragma once

#include <span>

#include "processing/brdf/brdf.h"
#include "processing/brdf/lafortune_base.h"

namespace lumitexel {

// A lobe's value is strength * gain + offset. Slopes by ln(shape) and by aim (radians).
struct LobeTerms {
  double gain = 0, offset = 0;
};
struct LobeSlopes {
  double gain = 0, offset = 0;
  double gain_by_shape = 0, offset_by_shape = 0, gain_by_aim = 0;
};

// A lobe's shape and aim, and what follows from them before any geometry is known: worked out once for many samples.
struct LobeShape {
  double log_shape = 0, aim = kMirrorAim;
  double shape = 1;     // exp(log_shape)
  LafortuneAim toward;  // of families that aim
};

struct LobeFamily {
  const char* name;
  bool aims;                                // whether `aim` is a parameter
  double least_log_shape, most_log_shape;   // where the formula is valid; kernels clamp nothing
  double least_aim, most_aim;
  // ln of the greatest strength that reflects no more than `energy` times the light it gets, about.
  double (*most_log_strength)(double log_shape, double energy);
  std::span<const double> start_log_shapes;  // where a fit begins, broad to sharp
  // Both for cos_i, cos_o > 0.
  LobeTerms (*terms_of)(const LobeShape& shape, const LobeGeometry& geometry);
  LobeSlopes (*slopes_of)(const LobeShape& shape, const LobeGeometry& geometry);

  LobeShape shape(double log_shape, double aim) const;
  LobeTerms terms(double log_shape, double aim, const LobeGeometry& geometry) const {
    return terms_of(shape(log_shape, aim), geometry);
  }
  LobeSlopes slopes(double log_shape, double aim, const LobeGeometry& geometry) const {
    return slopes_of(shape(log_shape, aim), geometry);
  }
};

extern const LobeFamily kLafortuneFamily, kGgxFamily, kWardFamily;
const LobeFamily& lobe_family(BrdfFamily family);

}  // namespace lumitexel
