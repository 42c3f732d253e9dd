// What is expected of a response before any sample: that its log slope bends gently.
#pragma once

#include <Eigen/Core>

#include "processing/image/response/response_spline.h"

namespace lumitexel {

using ResponseMatrix = Eigen::Matrix<double, ResponseSpline::kCoefficients, ResponseSpline::kCoefficients>;

// How much the spline bends: the sum of its coefficients' squared second differences, as a quadratic form of them.
ResponseMatrix bend_form();
// The prior's inverse covariance: second differences of the log slope are normal with a sigma of 0.06.
ResponseMatrix response_prior();
// The change of the coefficients that changes the curve's scale and nothing else.
ResponseSpline::Vector scale_direction();

}  // namespace lumitexel
