// Where the last stage of a fit predicts photographs kept out of it worse than a stage before did: what was learnt last is of the fit's
// photographs alone, and a fit that stops earlier would serve new views better.
#pragma once

#include <string>
#include <vector>

#include "processing/evaluation/evaluate_model.h"

namespace lumitexel {

// By one measure of ImageError, pooled over the photographs kept out.
struct StageCaution {
  const char* measure = "";  // "relative", "clipped", "square roots"
  double last = 0;           // at the last stage
  double before = 0;         // the least of the stages before it
  FitStage better = FitStage::Single;  // which one that was
};

// Two pooled errors differ by less than this for no reason but which photographs were kept out.
inline constexpr double kWorseByShare = 0.02;

// Of each measure by which the last stage is worse; empty as a rule, and where no photograph was kept out.
std::vector<StageCaution> stage_cautions(const Evaluation& evaluation);

// In one sentence for people, without an end; empty without cautions.
std::string in_words(const std::vector<StageCaution>& cautions);

}  // namespace lumitexel
