// Lobes and geometries in 113-bit arithmetic, straight from their definitions: what the kernels are measured against.
#pragma once

#include "processing/brdf/lobe_family.h"

namespace lumitexel {

__extension__ typedef __float128 Quad;

struct QuadGeometry {
  Quad cos_i, cos_o, mirror_gap, retro_gap, across2;  // as in LobeGeometry
};

// The stored geometry taken as exact: what is left is the kernel's own error.
QuadGeometry as_stored(const LobeGeometry& geometry);

// Light and view by their angles to the normal and the azimuth between them, radians, in exact arithmetic. The difference to
// as_stored(rounded(…)) is what making a geometry of doubles costs.
struct DirectionPair {
  double theta_i = 0, theta_o = 0, azimuth = 0;
};
QuadGeometry exact_geometry(const DirectionPair& pair);
LobeGeometry rounded_geometry(const DirectionPair& pair);  // through directions rounded to double and lobe_geometry()

struct QuadSlopes {
  Quad gain = 0, offset = 0;
  Quad gain_by_shape = 0, offset_by_shape = 0, gain_by_aim = 0;  // as in LobeSlopes
};
QuadSlopes reference_slopes(BrdfFamily family, double log_shape, double aim, const QuadGeometry& geometry);

}  // namespace lumitexel
