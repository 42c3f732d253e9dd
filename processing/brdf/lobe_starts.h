// Where a lobe fit begins.
#pragma once

#include <span>

#include "processing/brdf/error_model.h"
#include "processing/brdf/lafortune.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// For fixed lobe shape the model is linear in kd and A, so each shape of a small grid (mirror direction and a little off
// it, N from 3 to 1000) is solved in closed form, per channel with both kept from becoming negative, on at most some
// thousand of the samples; the best is returned. Deterministic.
LafortuneBrdf best_lobe_start(std::span<const Observation* const> samples, int channels, const ErrorModel& error);

}  // namespace lumitexel
