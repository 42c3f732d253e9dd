// How many of a material's bases its texels may mix: no more than predict left-out samples better.
#pragma once

#include <optional>
#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/project_weights.h"

namespace lumitexel {

struct BasesChoice {
  std::size_t bases = 0;
  PriorChoice prior;         // with them
  std::optional<Gain> gain;  // of all of `basis` over the material's own variations; nothing where there is no more
};

// Either the material with its variations (kVariations of material_basis.h), or all of `basis`, if left-out samples of the members are then
// predicted better as worth_having (choice.h) asks. The material alone is not asked: it is what a
// prior under which nothing varies makes of any basis.
BasesChoice choose_bases(const Observations& observations, const std::vector<std::size_t>& members, const std::vector<Brdf>& basis,
                         const ErrorModel& error, Precision precision);

}  // namespace lumitexel
