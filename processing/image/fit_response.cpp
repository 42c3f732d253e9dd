#include "processing/image/fit_response.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "drivers/error.h"
#include "processing/image/response/bracket_pixels.h"
#include "processing/image/response/response_kinks.h"
#include "processing/image/response/response_least_squares.h"

namespace lumitexel {
namespace {

constexpr double kWorstRelativeSigma = 0.05;
constexpr int kPoints = 65;
constexpr double kSurely = 2.0;

// Of chi-square with n degrees of freedom, exceeded with 1 %, by Wilson and Hilferty.
double rare_chi_square(int n) {
  const double spread = 2.0 / (9.0 * n);
  return n * std::pow(1.0 - spread + 2.326 * std::sqrt(spread), 3);
}

// Wald's statistic of "no bend", which a curve without kinks tells.
void state_test(const ResponseLeastSquares& fit, ResponseFit& result) {
  const ResponseMatrix& normal = fit.reduced().normal;
  const ResponseMatrix known = fit.covariance() * normal;  // the prior keeps the rest from moving at all
  result.freedoms = std::max(1, static_cast<int>(std::lround((known * known).trace())));
  result.chi_square =
      fit.parameters().dot(normal * fit.parameters()) / std::max(1.0, std::pow(fit.residual_scale(), 2));
}

void state_points(const ResponseLeastSquares& fit, const LinearSensor& sensor, const UnitSensor& unit,
                  ResponseFit& result) {
  const ResponseSpline curve(fit.parameters());
  const ResponseMatrix covariance = fit.covariance() * std::max(1.0, std::pow(fit.residual_scale(), 2));
  const double reference = ResponseLeastSquares::kReference, lowest = std::max(fit.reduced().lowest, 0.0);
  const ResponseSpline::Vector at_reference = curve.linear_gradient(reference) / curve.linear(reference);
  result.points.clear();
  for (int i = 0; i < kPoints; ++i) {
    const double u = lowest + (fit.reduced().highest - lowest) * std::pow((i + 1.0) / kPoints, 2);
    const ResponseSpline::Vector slope = curve.linear_gradient(u) / curve.linear(u) - at_reference;
    const double sigma = std::sqrt(slope.dot(covariance * slope));
    result.points.push_back({sensor.black_level_dn + u * unit.range_dn, curve.linear(u) * unit.range_dn, sigma});
  }
}

// Against the straight line that fits best: by so much at least, kSurely standard deviations taken off, or the points
// near black, good to half a percent, would find every long list of them bent somewhere.
double largest_departure(const std::vector<ResponsePoint>& points, double black_level_dn) {
  double sum = 0.0, weights = 0.0;
  for (const ResponsePoint& point : points) {
    const double weight = 1.0 / (point.relative_sigma * point.relative_sigma + 1e-8);
    sum += weight * std::log(point.linear_dn / (point.code_dn - black_level_dn));
    weights += weight;
  }
  double largest = 0.0;
  for (const ResponsePoint& point : points) {
    const double straight = (point.code_dn - black_level_dn) * std::exp(sum / weights);
    const double departure = std::abs(point.linear_dn / straight - 1.0);
    largest = std::max(largest, departure - kSurely * point.relative_sigma);
  }
  return largest;
}

void state_fit(const ResponseLeastSquares& fit, const LinearSensor& sensor, const UnitSensor& unit,
               ResponseFit& result) {
  result.residual_scale = fit.residual_scale();
  result.electrons_per_dn = 1.0 / (fit.shot() * unit.range_dn);
  result.electrons_measured = fit.shot_measured();
  state_points(fit, sensor, unit, result);
  result.largest_departure = largest_departure(result.points, sensor.black_level_dn);
  result.determined = result.points[kPoints / 4].relative_sigma < kWorstRelativeSigma &&
                      result.points.back().relative_sigma < kWorstRelativeSigma;
}

ResponseCurve tabulated(const ResponseLeastSquares& fit, const LinearSensor& sensor, const UnitSensor& unit) {
  constexpr int kNodes = 512;
  const ResponseSpline curve(fit.parameters());
  std::vector<double> codes, linears;
  for (int i = 0; i <= kNodes; ++i) {
    const double u = ResponseSpline::at_place(static_cast<double>(i) / kNodes);
    codes.push_back(sensor.black_level_dn + u * unit.range_dn);
    linears.push_back(curve.linear(u) * unit.range_dn);
  }
  return ResponseCurve(std::move(codes), std::move(linears));
}

}  // namespace

ResponseFit fit_response(const std::vector<std::vector<Frame>>& brackets, const LinearSensor& sensor) {
  check_sensor(sensor);
  if (brackets.empty()) throw BadInput("response", "no bracket", "at least one");
  const UnitSensor unit(sensor);
  ResponseLeastSquares fit(chosen_pixels(brackets, sensor), unit);
  ResponseFit result;
  result.iterations = fit.run();
  result.pixels = fit.reduced().pixels;
  if (result.iterations == 0) {
    const bool few = result.pixels < ResponseLeastSquares::kFewestPixels;
    result.why = few ? "too few pixels with two usable exposures" : "no convergence";
    return result;
  }
  state_test(fit, result);
  state_fit(fit, sensor, unit, result);
  if (!result.determined) {
    result.why = "the exposures overlap too little to know the curve to 5 %";
    return result;
  }
  if (result.chi_square < rare_chi_square(result.freedoms) || result.largest_departure < kNegligibleCurvature)
    return result;
  ResponseLeastSquares kinked = fit;
  result.iterations += add_kinks(kinked);
  if (kinked.kinks() > 0) {
    ResponseFit with_kinks = result;
    state_fit(kinked, sensor, unit, with_kinks);
    if (with_kinks.determined) {
      result = with_kinks;
      result.kinks = kinked.kinks();
      fit = std::move(kinked);
    }
  }
  result.curve = tabulated(fit, sensor, unit);
  return result;
}

}  // namespace lumitexel
