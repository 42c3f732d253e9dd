#include "processing/fit/tradeoff_run.h"

#include <algorithm>
#include <ctime>

#include "drivers/error.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/fit/coarser_session.h"
#include "processing/fit/fit_model.h"
#include "processing/fit/thinned_session.h"

namespace lumitexel {
namespace {

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void take_costs(const std::vector<StageCost>& stages, bool own_memory, TradeoffRun& run) {
  std::int64_t peak_bytes = 0;
  for (const StageCost& stage : stages) {
    run.seconds += stage.seconds;
    peak_bytes = std::max(peak_bytes, stage.peak_bytes);
  }
  if (own_memory) run.peak_bytes = peak_bytes;
}

void take_errors(const Evaluation& evaluation, TradeoffRun& run) {
  const ImageError& pooled = *evaluation.heldout[static_cast<std::size_t>(evaluation.last_stage)];
  run.relative.pooled = pooled.relative_rms;
  run.clipped.pooled = pooled.clipped_rms;
  run.square_root.pooled = pooled.sqrt_rms;
  for (const ViewEvaluation& view : evaluation.views) {
    if (!view.heldout) continue;
    run.relative.by_view.push_back(view.error.relative_rms);
    run.clipped.by_view.push_back(view.error.clipped_rms);
    run.square_root.by_view.push_back(view.error.sqrt_rms);
  }
}

}  // namespace

// Geometry, samples, materials, weights, comparison; bases and weights again; light between surfaces; normals and their trial, materials
// and weights again.
int stages_of(const FitOptions& options) {
  int stages = options.principal_functions ? 7 : 5;
  if (options.interreflections.choice != InterreflectionChoice::Off) stages += options.interreflections.rounds;
  if (options.normals == NormalChoice::Auto) ++stages;
  if (options.normals != NormalChoice::Mesh) stages += 3;
  return stages;
}

TradeoffRun run_setting(const CalibratedSession& session, const CalibratedSession& heldout, const TradeoffSetting& setting, Progress& progress) {
  TradeoffRun run;
  const std::size_t views = setting.fit_views == 0 ? fit_views(session) : setting.fit_views;
  if (views > fit_views(session)) {
    run.failure = "the session has " + std::to_string(fit_views(session)) + " photographs to fit";
    return run;
  }
  run.fit_views = views;
  try {
    const CoarserSession coarser(with_fit_views(session, views), setting.pixel_block);
    const bool own_memory = restart_peak_memory();
    const double cpu_before = cpu_seconds();
    const FittedModel fitted = fit_model(coarser.session(), setting.options, {}, progress);
    run.cpu_seconds = cpu_seconds() - cpu_before;
    run.materials = fitted.model.materials.size();
    take_costs(fitted.summary.stages, own_memory, run);
    take_errors(evaluate_model(fitted.model, heldout, progress), run);
  } catch (const BadInput&) {
    throw;
  } catch (const Corrupt&) {
    throw;  // the session's files, not this setting
  } catch (const Error& error) {
    run.failure = error.what();
  }
  return run;
}

}  // namespace lumitexel
