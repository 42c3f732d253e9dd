// What GGX and Ward have in common: lobes about the half vector, with a roughness alpha for a shape and a reflectance for a strength.
#pragma once

#include <cmath>

#include "processing/brdf/lobe_family.h"

namespace lumitexel {

inline constexpr double kPi = 3.141592653589793;
inline constexpr double kLeastAlong2 = 1e-60;  // both directions within 1e-30 of the surface's plane: dark, rather than a quotient of zeros
inline constexpr double kLeastLogAlpha = -6.907755278982137;  // 1e-3
// alpha = 0.9, 0.6, 0.4, 0.25, 0.15, 0.08, 0.04
inline constexpr double kStartLogAlphas[] = {-0.10536051565782628, -0.5108256237659907, -0.916290731874155, -1.3862943611198906,
                                             -1.8971199848858813,  -2.5257286443082556, -3.2188758248682006};

inline LobeFamily half_vector_family(const char* name, LobeTerms (*terms)(const LobeShape&, const LobeGeometry&),
                                     LobeSlopes (*slopes)(const LobeShape&, const LobeGeometry&)) {
  const auto most_log_strength = [](double, double energy) { return std::log(energy); };
  return {name, false, kLeastLogAlpha, 0.0, kMirrorAim, kMirrorAim, most_log_strength, kStartLogAlphas, terms, slopes};
}

}  // namespace lumitexel
