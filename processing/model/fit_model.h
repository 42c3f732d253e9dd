// The whole chain of processing, from a calibrated session to a model.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/fit_options.h"
#include "processing/model/model.h"
#include "processing/model/outliers.h"
#include "processing/model/stage_errors.h"
#include "processing/model/stage_timer.h"
#include "processing/surface/lumitexel.h"
#include "rig/progress.h"

namespace lumitexel {

struct FitSummary {
  std::size_t lumitexels = 0, samples = 0, unseen_triangles = 0, starved = 0;  // starved: lumitexels without samples
  LayoutSummary layout;
  RejectionCounts rejected;
  RejectedSamples unusable;          // gathered, but not finite or below the surface
  ErrorModel error;                  // that the fit started from, or was given
  ErrorSource errors = ErrorSource::Given;  // whose error models the materials have, never Auto
  std::vector<std::size_t> texels_by_material, texels_before_normals;  // the second only where normals were fitted
  std::vector<PriorChoice> prior;    // per material, of the last stage
  StageError single, cluster, projection;
  std::optional<StageError> pfa;     // if principal functions were asked for
  std::optional<StageError> normal;  // if normals were fitted
  Outliers outliers;                 // under the finished model
  std::vector<StageCost> stages;
};

struct FittedModel {
  Model model;  // provenance_json filled
  FitSummary summary;
};

// timer: may already hold the stages that came before (calibration). Throws Error if the views see nothing of the mesh lit.
FittedModel fit_model(const CalibratedSession& session, const FitOptions& options, StageTimer timer, Progress& progress);

}  // namespace lumitexel
