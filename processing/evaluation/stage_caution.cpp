#include "processing/evaluation/stage_caution.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "processing/brdf/choice.h"

namespace lumitexel {
namespace {

struct Measure {
  const char* name;
  double ImageError::*value;
};
constexpr Measure kMeasures[] = {{"clipped", &ImageError::clipped_rms}, {"square roots", &ImageError::sqrt_rms}};

std::size_t index(FitStage stage) { return static_cast<std::size_t>(stage); }

// One entry a photograph kept out.
std::vector<double> by_photograph(const Evaluation& evaluation, FitStage stage, double ImageError::*value) {
  std::vector<double> errors;
  for (const ErrorByStage& view : evaluation.heldout_views) errors.push_back(view[index(stage)] ? (*view[index(stage)]).*value : NAN);
  return errors;
}

bool surely_worse(const Evaluation& evaluation, FitStage last, FitStage before, double ImageError::*value) {
  const PairedDifference excess = paired_difference(by_photograph(evaluation, last, value), by_photograph(evaluation, before, value), Judges::Photographs);
  return excess.sum > 0.0 && excess.sum > kGainStandardErrors * excess.sigma;  // false of what is no number
}

// What leaves the last stage out.
const char* advice(FitStage last) {
  switch (last) {
    case FitStage::Normal: return "`fit --normals mesh` leaves it out";
    case FitStage::Pfa: return "`fit` without --principal-functions, or not by --method paper, leaves it out";
    case FitStage::Projection: return "`fit --bases 1` mixes nothing";
    case FitStage::Single:
    case FitStage::Cluster: break;
  }
  return "fewer materials may do";
}

}  // namespace

std::vector<StageCaution> stage_cautions(const Evaluation& evaluation) {
  std::vector<StageCaution> cautions;
  const FitStage last = evaluation.last_stage;
  if (evaluation.heldout_views.size() < kFewestForCaution || !evaluation.heldout[index(last)]) return cautions;
  for (const Measure& measure : kMeasures) {
    StageCaution caution{measure.name, (*evaluation.heldout[index(last)]).*measure.value, HUGE_VAL, FitStage::Single};
    for (const FitStage stage : kFitStages) {
      const auto& error = evaluation.heldout[index(stage)];
      if (stage == last || !error || !((*error).*measure.value < std::min(caution.before, caution.last))) continue;
      if (!surely_worse(evaluation, last, stage, measure.value)) continue;
      caution.before = (*error).*measure.value;
      caution.better = stage;
    }
    if (std::isfinite(caution.before)) cautions.push_back(caution);
  }
  return cautions;
}

std::string in_words(const std::vector<StageCaution>& cautions, FitStage last) {
  std::string text;
  for (const StageCaution& caution : cautions) {
    char part[120];
    std::snprintf(part, sizeof part, "%s %s %.3g at stage %s, %.3g at %s", text.empty() ? "" : ";", caution.measure, caution.before,
                  to_string(caution.better), caution.last, to_string(last));
    text += part;
  }
  if (text.empty()) return text;
  return "photographs kept out of the fit were predicted better before its last stage:" + text +
         "; what it learnt last serves the fit's photographs, not new ones (more photographs help; " + advice(last) + ")";
}

}  // namespace lumitexel
