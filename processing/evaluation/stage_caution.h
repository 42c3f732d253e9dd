// Where the last stage of a fit predicts photographs kept out of it worse than a stage before did, and surely: what was learnt last is of the
// fit's photographs alone, and a fit that stops earlier would serve new views better.
#pragma once

#include <string>
#include <vector>

#include "processing/evaluation/evaluate_model.h"

namespace lumitexel {

// By one measure of ImageError. Relative errors are not asked: one spike decides them.
struct StageCaution {
  const char* measure = "";  // "clipped", "square roots"
  double last = 0;           // pooled over the photographs kept out, at the last stage
  double before = 0;         // the least of the stages before it that are surely better
  FitStage better = FitStage::Single;  // which one that was
};

// Surely: in the mean over photographs, by two standard errors of the paired difference (choice.h); of fewer than so many nothing is sure.
inline constexpr std::size_t kFewestForCaution = 3;

// Of each measure by which the last stage is worse; empty as a rule.
std::vector<StageCaution> stage_cautions(const Evaluation& evaluation);

// In one sentence for people, without an end; empty without cautions. last: the model's last stage.
std::string in_words(const std::vector<StageCaution>& cautions, FitStage last);

}  // namespace lumitexel
