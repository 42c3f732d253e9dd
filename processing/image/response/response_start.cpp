#include "processing/image/response/response_start.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "processing/image/response/response_prior.h"

namespace lumitexel {
namespace {

using Coefficients = ResponseSpline::Coefficients;

// log L as a sum of log u and splines over the place of u.
constexpr int kTerms = ResponseSpline::kCoefficients + 1;
using Terms = Eigen::Matrix<double, kTerms, 1>;
Terms terms(double u) {
  Terms row;
  row << std::log(u), ResponseSpline::basis(u);
  return row;
}

struct Equations {
  Eigen::Matrix<double, kTerms, kTerms> normal = 1e-3 * Eigen::Matrix<double, kTerms, kTerms>::Identity();
  Terms right = 1e-3 * Terms::Unit(0);  // without any light: a straight line
  double lowest = 1.0;

  Equations() {
    normal.bottomRightCorner<ResponseSpline::kCoefficients, ResponseSpline::kCoefficients>() += bend_form();
  }

  void add(const BracketPixel& pixel, const UnitSensor& sensor) {
    double weights = 0.0, mean_log_s = 0.0;
    Terms mean = Terms::Zero();
    for (int pass = 0; pass < 2; ++pass) {
      for (const PixelSample& sample : pixel.samples) {
        const double variance = sensor.reads + sensor.shot * std::max(sample.u, 0.0);
        if (!sample.counts || sample.u < 5.0 * std::sqrt(variance)) continue;
        const double weight = sample.u * sample.u / variance;
        const Terms row = terms(sample.u);
        if (pass == 0) {
          weights += weight;
          mean += weight * row;
          mean_log_s += weight * std::log(sample.time_s);
          lowest = std::min(lowest, sample.u);
        } else {
          const Terms off = row - mean / weights;
          normal += weight * off * off.transpose();
          right += weight * off * (std::log(sample.time_s) - mean_log_s / weights);
        }
      }
      if (weights == 0.0) break;
    }
  }
};

// From log L to log slope, and that to the spline.
Coefficients spline_of(const Terms& log_curve, double lowest) {
  CoefficientMatrix normal = 0.1 * bend_form() + 1e-9 * CoefficientMatrix::Identity();
  Coefficients right = Coefficients::Zero();
  for (int i = 1; i <= 100; ++i) {
    const double u = ResponseSpline::at_place(0.01 * i), delta = 1e-3 * u;
    if (u < lowest) continue;
    const double below = log_curve.dot(terms(u - delta)), above = log_curve.dot(terms(std::min(u + delta, 1.0)));
    const double steepness = std::max((above - below) / (std::min(u + delta, 1.0) - u + delta), 0.1 / u);
    const Coefficients row = ResponseSpline::basis(u);
    normal += row * row.transpose();
    right += row * (log_curve.dot(terms(u)) + std::log(steepness));
  }
  return normal.ldlt().solve(right);
}

}  // namespace

Coefficients starting_curve(const std::vector<BracketPixel>& pixels, const UnitSensor& sensor) {
  Equations equations;
  for (const BracketPixel& pixel : pixels) equations.add(pixel, sensor);
  return spline_of(equations.normal.ldlt().solve(equations.right), equations.lowest);
}

}  // namespace lumitexel
