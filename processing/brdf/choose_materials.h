// How many materials a scene requires, by what its texels miss. A texel mixes the materials that there are for itself, and may do as well with
// fewer than its whole surface is best told apart by; and materials found in samples that err together, as they do where the mesh's normals
// are wrong, may predict others worse than fewer would.
#pragma once

#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/mixture.h"

namespace lumitexel {

// The number that need prove nothing; any other has to predict samples left out (projected_error.h) better by what Claim::Richer asks
// (error_choice.h). Half a percent of all error at the least: so a material on a two hundredth of the surface stays where the error there is over
// twice as large without it.
enum class Presumed {
  Few,  // where materials were told apart by an error model that nobody vouches for
  Many  // where evidence has asked for each of them, among residuals whose size and correlation it knew
};

struct ChosenMaterials {
  std::size_t candidate = 0;
  std::vector<Choice> choices;  // the last that was taken, and of those refused in its favour the nearest to it; none where there is nothing to choose
};

// candidates: of the same learners, from many materials to few. judges: lumitexels that have not learnt, where there are enough.
ChosenMaterials choose_materials(const std::vector<Mixture>& candidates, Presumed presumed, const Observations& observations,
                                 const LumitexelList& learners, const LumitexelList& judges);

}  // namespace lumitexel
