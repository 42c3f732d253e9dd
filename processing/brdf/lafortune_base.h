// The base D of Lafortune's power (lafortune.cpp) as one minus gaps: the only form that keeps its digits near the peak.
//
//   D = 1 - (mirror * mirror_gap + retro * retro_gap + grazing * cos_i cos_o)
//
// None of the three coefficients is negative, so nothing cancels before the subtraction from one.
#pragma once

#include "processing/brdf/lobe_geometry.h"

namespace lumitexel {

struct LafortuneAim {
  double mirror = 1, retro = 0, grazing = 0;
  double gap_slope = 0, grazing_slope = 0;  // of 1 - D by phi, radians: gap_slope is mirror's, and minus retro's

  double below_one(const LobeGeometry& g) const {  // 1 - D
    return mirror * g.mirror_gap + retro * g.retro_gap + grazing * g.normal_product();
  }
  double slope(const LobeGeometry& g) const {  // dD / d(phi)
    return -(gap_slope * (g.mirror_gap - g.retro_gap) + grazing_slope * g.normal_product());
  }
};

// phi from -pi/2 to pi/2, taken as exact.
LafortuneAim lafortune_aim(double phi);

// D as if worked out in some 100 bits, geometry and phi taken as exact: for bases so near to zero that a power below one shows every
// digit.
double careful_base(double phi, const LobeGeometry& geometry);

}  // namespace lumitexel
