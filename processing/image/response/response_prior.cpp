#include "processing/image/response/response_prior.h"

namespace lumitexel {
namespace {

constexpr double kBendSigma = 0.06;  // sRGB's kink is about twice that

}  // namespace

ResponseMatrix bend_form() {
  ResponseMatrix sum = ResponseMatrix::Zero();
  for (int k = 0; k + 2 < ResponseSpline::kCoefficients; ++k) {
    ResponseSpline::Vector second = ResponseSpline::Vector::Zero();
    second[k] = second[k + 2] = 1.0;
    second[k + 1] = -2.0;
    sum += second * second.transpose();
  }
  return sum;
}

ResponseMatrix response_prior() { return bend_form() / (kBendSigma * kBendSigma); }

ResponseSpline::Vector scale_direction() { return ResponseSpline::Vector::Ones(); }

}  // namespace lumitexel
