// How badly a BRDF explains samples: minus twice the log likelihood under an error model, up to a constant. 0 for no samples.
#pragma once

#include <span>

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

double misfit(const Brdf& brdf, std::span<const Observation> samples, const ErrorModel& error);
// Every sample counted by its share.
double misfit(const Brdf& brdf, FitSamples samples, const ErrorModel& error);

}  // namespace lumitexel
