// Merges materials of a mixture as long as the samples do not object.
#pragma once

#include <functional>
#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/mixture.h"

namespace lumitexel {

// How many materials `materials = 0` leaves, of those that merging passes, is for texels to say (choose_materials.h). Where error models are
// given, or photographs judge, few are presumed. Where they are estimated, and to be believed, what evidence asks for is, and there are never more: a pair is merged
// unless keeping it apart gains both
//   2 * independence * gain > ln(n) for each parameter of one material (the Bayesian information criterion, tempered as in
//   fit_material.h), and
//   kLeastGain of log likelihood for each sample of the pair: a difference too small to see is none, however many samples prove it.
// The gain is measured with the pair's common error model, so that materials must differ in what they look like, not in how well
// they are explained; and it must be there, too, if lumitexels may differ by a common factor (shared_brightness.h).
inline constexpr double kLeastGain = 0.02;

struct MergeOptions {
  int materials = 0;  // merge until so many are left; 0: as many as texels say
  MaterialFitOptions fit;
  LumitexelList judges = {};  // who say what texels miss; none: the lumitexels themselves
};

// `mixture` should have settled. Greedy: always the pair whose merging loses least likelihood, then the mixture settles again. Returns what was
// said of the number. report: called with the steps left, down to 1: each merge is one, and choosing the number kChoosingSteps.
std::vector<Choice> merge_materials(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                    const MergeOptions& options, const std::function<void(int)>& report);

}  // namespace lumitexel
