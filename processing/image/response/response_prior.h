// What is expected of a response before any sample: that its log slope bends gently.
#pragma once

#include <Eigen/Core>

#include "processing/image/response/response_spline.h"

namespace lumitexel {

// Of a spline's coefficients; of all parameters.
using CoefficientMatrix = Eigen::Matrix<double, ResponseSpline::kCoefficients, ResponseSpline::kCoefficients>;
using ResponseMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, ResponseSpline::kMostParameters,
                                     ResponseSpline::kMostParameters>;

// The k-th second difference of the coefficients, k < kBends: where the spline bends at the place k / kSpans.
inline constexpr int kBends = ResponseSpline::kCoefficients - 2;
ResponseSpline::Coefficients bend(int k);
// The sum of their squares, as a quadratic form of the coefficients.
CoefficientMatrix bend_form();
// The prior's inverse covariance for so many parameters: bends are normal with bend_sigma. A kink's bend is normal with
// kKinkBend, what parts a straight line from a gamma of 2.2; it lies anywhere.
inline constexpr double kKinkBend = 5.0;
ResponseMatrix bend_prior(Eigen::Index parameters, double bend_sigma);
ResponseMatrix kink_prior(Eigen::Index parameters);

// bend_sigma is chosen by the samples, as if kBendsSeen bends of kTypicalBend had been seen before.
inline constexpr double kBendsSeen = 2.0, kTypicalBend = 0.06;
// Where the evidence is largest about a quadratic misfit (normal, right: about `parameters`); MacKay (1992), eq. 4.
// normal: regular, without the prior of bends.
double likeliest_bend_sigma(const ResponseMatrix& normal, const ResponseSpline::Vector& right,
                            const ResponseSpline::Vector& parameters, double bend_sigma);

}  // namespace lumitexel
