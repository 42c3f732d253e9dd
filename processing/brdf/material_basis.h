// The BRDFs that a material's texels may mix (section 8.1 of the paper).
#pragma once

#include <vector>

#include "processing/brdf/brdf.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

inline constexpr std::size_t kVariations = 2;  // of itself among a material's bases, behind itself

// For each material: first itself, then two variations of itself (more and less diffuse light, with a sharper and a
// broader lobe), then up to five others: those that border on it most (neighbour_counts[a][b]: pairs of adjacent texels of
// materials a and b), then those most like it. At most kMaxBasis in all.
std::vector<std::vector<Brdf>> material_bases(const std::vector<Brdf>& materials,
                                                       const std::vector<std::vector<std::size_t>>& neighbour_counts,
                                                       const Observations& observations);

}  // namespace lumitexel
