// The error model that a material's own residuals speak for: scales, tails, and how far channels and a lumitexel's samples
// err together.
#pragma once

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// Student's tails, or two normal distributions where those are likelier by more than they cost (the Bayesian information criterion).
// Maximum likelihood, about, for the given BRDF; `start` is where the iteration begins and what is kept where samples are too few
// to tell (fewer than 30). samples of one lumitexel must follow each other.
ErrorModel estimate_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& start);

// The same from where `error` is, one step, with its kind of tails and its independence kept: for use inside an iteration of the caller's.
ErrorModel updated_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& error);

// ErrorModel::independence, as these residuals show it.
double independence_of(const Brdf& brdf, FitSamples samples, const ErrorModel& error);

}  // namespace lumitexel
