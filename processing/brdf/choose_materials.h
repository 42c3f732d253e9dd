// How many materials a scene requires, by what its texels miss. A texel mixes the materials that there are for itself, and may do as well with
// fewer than its whole surface is best told apart by; and materials found in samples that err together, as they do where the mesh's normals
// are wrong, may predict others worse than fewer would.
//
// Where samples know their photographs, and there are kFewestPhotographs, every fourth photograph is left out in turn, materials are learnt again
// from the others, and each photograph is predicted: what errs together in one photograph, under one lamp, is then no material. Few
// are presumed, and a gain is sure by its scatter over photographs: what shows in three of them or fewer is not. Which lumitexels are whose begins
// as all photographs have it, and the BRDFs anew. Else samples are left out, and the scatter is that over lumitexels.
#pragma once

#include <functional>
#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/fit_material.h"
#include "processing/brdf/mixture.h"

namespace lumitexel {

// The number that need prove nothing where samples are left out; any other has to predict them (projected_error.h) better by what Claim::Richer
// asks (error_choice.h). Half a percent of all error at the least: so a material on a two hundredth of the surface stays where the error there is over
// twice as large without it.
enum class Presumed {
  Few,  // where materials were told apart by an error model that nobody vouches for
  Many  // where evidence has asked for each of them, among residuals whose size and correlation it knew
};

struct ChosenMaterials {
  std::size_t candidate = 0;
  std::vector<Choice> choices;  // the last that was taken, and of those refused in its favour the nearest to it; none where there is nothing to choose
};

inline constexpr std::size_t kFewestPhotographs = 10;

inline constexpr int kChoosingSteps = 40;  // that are reported: about as long as so many splits and merges

// candidates: of the same learners, from many materials to few, as `fit` says. judges: lumitexels that have not learnt, where there are enough.
// report: called with the steps left, down to 0.
ChosenMaterials choose_materials(const std::vector<Mixture>& candidates, Presumed presumed, const Observations& observations,
                                 const LumitexelList& learners, const LumitexelList& judges, const MaterialFitOptions& fit,
                                 const std::function<void(int)>& report);

}  // namespace lumitexel
