// How badly a BRDF explains samples.
#pragma once

#include <span>

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// Degrees of freedom of the Student's t that a sample's residuals are taken to follow.
inline constexpr double kFreedom = 4.0;

// Minus twice the log likelihood, up to a constant, of Student's t with the error model's variance. Its tails are
// heavy, so one missed shadow does not decide, yet never flat, so that even samples that no BRDF explains still know
// which one is nearer. 0 for no samples.
double misfit(const LafortuneBrdf& brdf, std::span<const Observation> samples, const ErrorModel& error);
double misfit(const LafortuneBrdf& brdf, std::span<const Observation* const> samples, const ErrorModel& error);

}  // namespace lumitexel
