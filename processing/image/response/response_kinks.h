// Kinks of a response, as many as the samples demand.
#pragma once

#include "processing/image/response/response_least_squares.h"

namespace lumitexel {

// Adds kinks to a converged fit one at a time, each where a bend of the spline would gain most by being free, as long
// as the evidence (ResponseLeastSquares::surprise) is for it. Returns the iterations it took.
int add_kinks(ResponseLeastSquares& fit);

}  // namespace lumitexel
