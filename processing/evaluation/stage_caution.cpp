#include "processing/evaluation/stage_caution.h"

#include <cmath>
#include <cstdio>

namespace lumitexel {
namespace {

struct Measure {
  const char* name;
  double ImageError::*value;
};
constexpr Measure kMeasures[] = {{"relative", &ImageError::relative_rms}, {"clipped", &ImageError::clipped_rms}, {"square roots", &ImageError::sqrt_rms}};

}  // namespace

std::vector<StageCaution> stage_cautions(const Evaluation& evaluation) {
  std::vector<StageCaution> cautions;
  const auto& last = evaluation.heldout[static_cast<std::size_t>(evaluation.last_stage)];
  if (!last) return cautions;
  for (const Measure& measure : kMeasures) {
    StageCaution caution{measure.name, (*last).*measure.value, HUGE_VAL, FitStage::Single};
    for (const FitStage stage : kFitStages) {
      const auto& error = evaluation.heldout[static_cast<std::size_t>(stage)];
      if (stage == evaluation.last_stage || !error || !((*error).*measure.value < caution.before)) continue;
      caution.before = (*error).*measure.value;
      caution.better = stage;
    }
    if (caution.last > (1.0 + kWorseByShare) * caution.before) cautions.push_back(caution);
  }
  return cautions;
}

std::string in_words(const std::vector<StageCaution>& cautions) {
  std::string text;
  for (const StageCaution& caution : cautions) {
    char part[120];
    std::snprintf(part, sizeof part, "%s %s %.3g at stage %s, %.3g at the last", text.empty() ? "" : ";", caution.measure, caution.before,
                  to_string(caution.better), caution.last);
    text += part;
  }
  if (text.empty()) return text;
  return "photographs kept out of the fit were predicted better before its last stage:" + text +
         "; what it learnt last serves the fit's photographs, not new ones (more photographs help, or a fit that stops earlier: "
         "--quality draft, --normals mesh, without --principal-functions)";
}

}  // namespace lumitexel
