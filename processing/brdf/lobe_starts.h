// Where a lobe fit begins.
#pragma once

#include "processing/brdf/brdf_parameters.h"
#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// `brdf` with one more lobe. For fixed lobe shapes the model is linear in kd and the strengths, so each shape of a small grid
// within the bounds (three aims if the family aims, its start_log_shapes) is solved in closed form, per channel and with nothing
// negative, on at most some thousand of the samples; the best is returned. Deterministic.
Brdf with_best_lobe(const Brdf& brdf, FitSamples samples, const LobeBounds& bounds, const ErrorModel& error);

// The best diffuse BRDF, weighted by the error model at `at`.
Brdf diffuse_alone(FitSamples samples, const ErrorModel& error, const Brdf& at);

}  // namespace lumitexel
