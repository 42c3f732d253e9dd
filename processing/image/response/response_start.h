// Where the fit of a response starts: Debevec and Malik's (1997) equations with a curve of few parameters.
#pragma once

#include "processing/image/response/bracket_pixels.h"
#include "processing/image/response/response_spline.h"

namespace lumitexel {

// log L = log rate + log time is linear in the parameters of log L, every pixel's rate eliminated. The errors of dim
// samples are not what it thinks, so it only starts the rest.
ResponseSpline::Coefficients starting_curve(const std::vector<BracketPixel>& pixels, const UnitSensor& sensor);

}  // namespace lumitexel
