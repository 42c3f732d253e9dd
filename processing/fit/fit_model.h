// The whole chain of processing, from a calibrated session to a model.
#pragma once

#include "processing/calibration/calibrated_session.h"
#include "processing/fit/fit_summary.h"
#include "processing/model/model.h"
#include "rig/progress.h"

namespace lumitexel {

struct FittedModel {
  Model model;  // provenance_json filled
  FitSummary summary;
};

// timer: may already hold the stages that came before (calibration). Throws BadInput if no photograph of the fit sees any of the mesh.
FittedModel fit_model(const CalibratedSession& session, const FitOptions& options, StageTimer timer, Progress& progress);

}  // namespace lumitexel
