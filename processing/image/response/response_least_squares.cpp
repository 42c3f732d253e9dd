#include "processing/image/response/response_least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "processing/image/response/response_start.h"

namespace lumitexel {
namespace {

using Vector = ResponseSpline::Vector;

constexpr int kMostIterations = 40;
constexpr int kSettling = 6;                // iterations that choose samples and measure the shot noise; then both stay
constexpr double kShotDominates = 1.0;      // over all other variance
constexpr double kFewestFreedoms = 1000.0;  // to measure shot noise to 5 %
// Of a pixel: each rate is fitted as well, which bends the curve by some 1 / this.
constexpr double kFewestElectrons = 600.0;
constexpr double kOutlierSigmas = 6.0;
constexpr double kConverged = 0.01;

}  // namespace

void ReducedEquations::add(const ResponseSpline& curve, const UnitSensor& sensor, const BracketPixel& pixel) {
  ResponseMatrix own = ResponseMatrix::Zero();
  Vector own_right = Vector::Zero(), mixed = Vector::Zero();
  double own_rate = 0.0, rate_right = 0.0, own_chi_square = 0.0;
  int count = 0, seen = 0;
  bool mostly_shot = true;
  for (const PixelSample& sample : pixel.samples) {
    if (!sample.counts) continue;
    const LinearisedSample at = linearised(curve, sensor, sample, pixel.rate);
    const Vector by_curve = -curve.linear_gradient(at.predicted) / at.slope;
    own += at.weight * by_curve * by_curve.transpose();
    own_right += at.weight * by_curve * at.residual;
    mixed += at.weight * at.by_rate * by_curve;
    own_rate += at.weight * at.by_rate * at.by_rate;
    rate_right += at.weight * at.by_rate * at.residual;
    ++count;
    if (sample.censored) continue;
    own_chi_square += at.weight * at.residual * at.residual;
    lowest = std::min(lowest, at.predicted);
    highest = std::max(highest, std::min(at.predicted, sensor.usable));
    mostly_shot = mostly_shot && at.weight * sensor.reads * (1.0 + kShotDominates) < 1.0;
    ++seen;
  }
  if (count < 2 || seen == 0 || own_rate * pixel.rate * pixel.rate < kFewestElectrons) return;
  normal += own - mixed * mixed.transpose() / own_rate;
  right += own_right - mixed * (rate_right / own_rate);
  chi_square += own_chi_square;
  samples += seen;
  if (mostly_shot && seen == count) {
    shot_chi_square += own_chi_square;
    shot_freedoms += seen - 1;
  }
  ++pixels;
}

ResponseLeastSquares::ResponseLeastSquares(std::vector<BracketPixel> pixels, const UnitSensor& sensor)
    : pixels_(std::move(pixels)), sensor_(sensor) {
  coefficients_.setZero();
}

int ResponseLeastSquares::run() {
  start();
  for (int iteration = 1; iteration <= kMostIterations; ++iteration) {
    const ResponseSpline curve(coefficients_);
    for (BracketPixel& pixel : pixels_) {
      improve_rate(curve, pixel);
      if (iteration <= kSettling) choose(curve, pixel);
    }
    reduced_ = ReducedEquations{};
    for (const BracketPixel& pixel : pixels_) reduced_.add(curve, sensor_, pixel);
    if (iteration <= kSettling) measure_shot_noise();
    if (reduced_.pixels < kFewestPixels) return 0;
    const Vector slope = reduced_.right - response_prior() * coefficients_;
    Vector step = regular().ldlt().solve(slope);
    if (!step.allFinite()) return 0;
    step *= std::min(1.0, 1.0 / std::max(1e-300, step.cwiseAbs().maxCoeff()));
    coefficients_ += step;
    fix_scale();
    // In units of chi-square: a coefficient that the samples do not know may move on for ever.
    if (slope.dot(step) < kConverged && iteration > kSettling) return iteration;
  }
  return 0;
}

ResponseMatrix ResponseLeastSquares::covariance() const { return regular().inverse(); }

// The scale is nothing that the samples know: whatever is added here changes it alone.
ResponseMatrix ResponseLeastSquares::regular() const {
  return reduced_.normal + response_prior() +
         (reduced_.normal.trace() / 100.0 + 1.0) * scale_direction() * scale_direction().transpose();
}

// electrons_per_dn is that of a linear sensor. What a unit of the linear value is here, only the residuals know.
void ResponseLeastSquares::measure_shot_noise() {
  shot_measured_ = reduced_.shot_freedoms > kFewestFreedoms;
  if (shot_measured_) sensor_.shot *= std::clamp(reduced_.shot_chi_square / reduced_.shot_freedoms, 0.5, 2.0);
}

void ResponseLeastSquares::fix_scale() {
  const double factor = kReference / ResponseSpline(coefficients_).linear(kReference);
  coefficients_ += std::log(factor) * scale_direction();
  for (BracketPixel& pixel : pixels_) pixel.rate *= factor;
}

void ResponseLeastSquares::start() {
  coefficients_ = starting_curve(pixels_, sensor_);
  const ResponseSpline curve(coefficients_);
  for (BracketPixel& pixel : pixels_) {
    double light = 0.0, time_s = 0.0;
    for (const PixelSample& sample : pixel.samples) {
      if (!sample.counts) continue;
      light += curve.linear(std::max(sample.u, 0.0));
      time_s += sample.time_s;
    }
    pixel.rate = time_s > 0.0 ? std::max(light / time_s, 1e-12) : 0.0;
  }
  fix_scale();
}

// By what the pixel's other samples predict: a choice in which a sample's own noise has a say prefers one sign of it.
void ResponseLeastSquares::choose(const ResponseSpline& curve, BracketPixel& pixel) const {
  double normal = 0.0, right = 0.0;
  std::vector<double> normals, rights;
  for (const PixelSample& sample : pixel.samples) {
    const LinearisedSample at = linearised(curve, sensor_, sample, pixel.rate);
    normals.push_back(sample.counts ? at.weight * at.by_rate * at.by_rate : 0.0);
    rights.push_back(sample.counts ? at.weight * at.by_rate * at.residual : 0.0);
    normal += normals.back();
    right += rights.back();
  }
  for (std::size_t k = 0; k < pixel.samples.size(); ++k) {
    PixelSample& sample = pixel.samples[k];
    const double others = normal - normals[k];
    const double rate = others > 1e-9 * normal ? pixel.rate + (right - rights[k]) / others : pixel.rate;
    const LinearisedSample at = linearised(curve, sensor_, sample, pixel.rate);
    const bool fits = sample.censored || at.residual * at.residual * at.weight < kOutlierSigmas * kOutlierSigmas;
    sample.counts = rate * sample.time_s > kDimmestElectrons * sensor_.shot && fits;
  }
}

void ResponseLeastSquares::improve_rate(const ResponseSpline& curve, BracketPixel& pixel) const {
  for (int step = 0; step < 2; ++step) {
    double normal = 0.0, right = 0.0;
    for (const PixelSample& sample : pixel.samples) {
      if (!sample.counts) continue;
      const LinearisedSample at = linearised(curve, sensor_, sample, pixel.rate);
      normal += at.weight * at.by_rate * at.by_rate;
      right += at.weight * at.by_rate * at.residual;
    }
    if (normal > 0.0) pixel.rate = std::max(pixel.rate + right / normal, 0.1 * pixel.rate);
  }
}

}  // namespace lumitexel
