// As many materials as wanted among some lumitexels: how they were looked for, and by what they were fitted.
#pragma once

#include <functional>

#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/left_out_error.h"

namespace lumitexel {

struct MaterialSearch {
  ErrorSource errors = ErrorSource::Given;  // never Auto
  MaterialFitOptions fit;                   // as every material was fitted
  Mixture mixture;
  std::vector<Choice> choices;              // that left-out samples made on the way to it
  std::vector<SquaredError> left_out;       // how it predicts them (left_out_error.h); empty until it is asked
  bool known_before = false;                // adapted, not found from nothing
};

// First, with lobes of options.fit.family and, but for LobeShapes::Separate, one shape for all channels: splits into more materials than
// wanted (split_materials.h), lets the mixture settle, merges (merge_materials.h). Auto: with the given error model and with estimated ones. Where there is more than one candidate, materials known before among them, error_choice.h decides.
// Then, where options ask for it, the same materials are fitted with lobes of each other family, and with a shape for each channel;
// error_choice.h decides again. Materials known before keep theirs.
// report: called with the steps done, of search_steps.
MaterialSearch search_for_materials(const Observations& observations, const LumitexelList& selection, const ClusterOptions& options,
                                    const std::function<void(int)>& report);

int search_steps(const ClusterOptions& options);

// Each material's lobes, asked for anew: while splitting and merging all had those of the whole. fits: one a material.
void choose_lobes(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                  const MaterialFitOptions& options, std::vector<BrdfFit>& fits);

}  // namespace lumitexel
