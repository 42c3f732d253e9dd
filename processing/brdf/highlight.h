// Whether a material has a highlight, and which of its samples see it.
#pragma once

#include "processing/brdf/brdf.h"
#include "processing/brdf/lobe_geometry.h"

namespace lumitexel {

// The mirror direction of light at 30 degrees: where gloss is asked about.
inline constexpr LobeGeometry kGlossGeometry = geometry_of_cosines(0.5, 0.8660254037844387, 0.8660254037844387);

// At least twice as bright there as its diffuse part, in the channels' mean.
bool has_highlight(const Brdf& brdf);

// At least a tenth of what the mirror direction, with light at the same angle, adds to the diffuse part.
bool near_highlight(const Brdf& brdf, const LobeGeometry& geometry);

}  // namespace lumitexel
