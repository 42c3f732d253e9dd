// Which lumitexels a material is learnt from (section 7.1 of the paper): those that probably saw a highlight, and
// some of all the others.
#pragma once

#include <cstddef>
#include <vector>

#include "processing/brdf/observations.h"

namespace lumitexel {

// How near the lumitexel came to a mirror reflection: the largest cosine between its normal and the half vector of a
// sample's directions. -1 without samples.
double mirror_nearness(std::span<const Observation> samples);

// At most `count` lumitexels with at least kFewestSamples samples, ascending: half of them spread over the third that came nearest to a
// mirror reflection, half over all. All that qualify if there are no more than `count`. Deterministic.
// draw: which of those that such a spread might choose (draw_phase.h).
inline constexpr std::size_t kFewestSamples = 3;  // fewer cannot tell a lobe from diffuse light
std::vector<std::size_t> select_lumitexels(const Observations& observations, std::size_t count, int draw = 0);

}  // namespace lumitexel
