// The error model that a material's own residuals speak for: scales, tails, and how far channels and a lumitexel's samples
// err together.
#pragma once

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// Maximum likelihood, about, for the given BRDF; `start` is where the iteration begins and what is kept where samples are too few
// to tell (fewer than 30). samples of one lumitexel must follow each other.
ErrorModel estimate_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& start);

// The same from where `error` is, one step and with its freedom kept: for use inside an iteration of the caller's.
ErrorModel updated_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& error);

}  // namespace lumitexel
