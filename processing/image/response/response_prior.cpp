#include "processing/image/response/response_prior.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace lumitexel {

ResponseSpline::Coefficients bend(int k) {
  ResponseSpline::Coefficients second = ResponseSpline::Coefficients::Zero();
  second[k] = second[k + 2] = 1.0;
  second[k + 1] = -2.0;
  return second;
}

CoefficientMatrix bend_form() {
  CoefficientMatrix sum = CoefficientMatrix::Zero();
  for (int k = 0; k < kBends; ++k) sum += bend(k) * bend(k).transpose();
  return sum;
}

ResponseMatrix bend_prior(Eigen::Index parameters, double bend_sigma) {
  ResponseMatrix prior = ResponseMatrix::Zero(parameters, parameters);
  prior.topLeftCorner<ResponseSpline::kCoefficients, ResponseSpline::kCoefficients>() =
      bend_form() / (bend_sigma * bend_sigma);
  return prior;
}

ResponseMatrix kink_prior(Eigen::Index parameters) {
  ResponseMatrix prior = ResponseMatrix::Zero(parameters, parameters);
  for (Eigen::Index k = ResponseSpline::kCoefficients; k < parameters; k += ResponseSpline::kOfKink)
    prior(k, k) = 1.0 / (kKinkBend * kKinkBend);
  return prior;
}

double likeliest_bend_sigma(const ResponseMatrix& normal, const ResponseSpline::Vector& right,
                            const ResponseSpline::Vector& parameters, double bend_sigma) {
  constexpr int kRounds = 30;
  for (int round = 0; round < kRounds; ++round) {
    const ResponseMatrix prior = bend_prior(parameters.size(), bend_sigma);
    const Eigen::LDLT<ResponseMatrix> solver(normal + prior);
    const ResponseSpline::Vector at = parameters + solver.solve(right - prior * parameters);
    const double told = kBends - solver.solve(prior).trace();  // bends that the samples know
    const double bent = at.dot(prior * at) * bend_sigma * bend_sigma;
    bend_sigma = std::sqrt((bent + kBendsSeen * kTypicalBend * kTypicalBend) / (std::max(0.0, told) + kBendsSeen));
  }
  return bend_sigma;
}

}  // namespace lumitexel
