// Shots that no plan wants, to tell frames apart by: every kind, settings that differ from each neighbour's, axes that
// move every few shots.
#pragma once

#include <cstdint>
#include <vector>

#include "rig/rig_description.h"
#include "rig/shot.h"

namespace lumitexel {

// ids 1, 2, …; a pure function of its arguments. shots_a_place: so many from one position of the axes.
std::vector<Shot> synthetic_shots(int count, const RigDescription& rig, std::uint64_t seed, int shots_a_place = 4);

}  // namespace lumitexel
