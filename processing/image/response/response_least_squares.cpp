#include "processing/image/response/response_least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/image/response/response_start.h"

namespace lumitexel {
namespace {

using Vector = ResponseSpline::Vector;

constexpr int kMostIterations = 40, kMostWithKink = 15;
constexpr int kSettling = 6;                // iterations that choose samples and measure the shot noise; then both stay
constexpr double kShotDominates = 1.0;      // over all other variance
constexpr double kFewestFreedoms = 1000.0;  // to measure shot noise to 5 %
// Of a pixel: each rate is fitted as well, which bends the curve by some 1 / this.
constexpr double kFewestElectrons = 600.0;
constexpr double kOutlierSigmas = 6.0;
constexpr double kConverged = 0.01;
constexpr double kFarthestMove = 0.3 / ResponseSpline::kSpans;  // of a kink, in one step

}  // namespace

ReducedEquations::ReducedEquations(Eigen::Index parameters)
    : normal(ResponseMatrix::Zero(parameters, parameters)), right(ResponseSpline::Vector::Zero(parameters)) {}

void ReducedEquations::add(const ResponseSpline& curve, const UnitSensor& sensor, const BracketPixel& pixel) {
  if (!pixel.tells) return;
  ReducedEquations own(right.size());
  Vector mixed = Vector::Zero(right.size());
  double by_rate = 0.0, rate_right = 0.0;
  int censored = 0;
  bool mostly_shot = true;
  for (const PixelSample& sample : pixel.samples) {
    if (!sample.counts) continue;
    const LinearisedSample at = linearised(curve, sensor, sample, pixel.rate);
    const Vector by_curve = -curve.linear_gradient(at.predicted) / at.slope;
    own.normal += at.weight * by_curve * by_curve.transpose();
    own.right += at.weight * by_curve * at.residual;
    mixed += at.weight * at.by_rate * by_curve;
    by_rate += at.weight * at.by_rate * at.by_rate;
    rate_right += at.weight * at.by_rate * at.residual;
    surprise += at.surprise;
    if (sample.censored) {
      ++censored;
      continue;
    }
    own.chi_square += at.weight * at.residual * at.residual;
    own.samples += 1.0;
    lowest = std::min(lowest, at.predicted);
    highest = std::max(highest, std::min(at.predicted, sensor.usable));
    mostly_shot = mostly_shot && at.weight * sensor.reads * (1.0 + kShotDominates) < 1.0;
  }
  normal += own.normal - mixed * mixed.transpose() / by_rate;
  right += own.right - mixed * (rate_right / by_rate);
  chi_square += own.chi_square;
  samples += own.samples;
  if (mostly_shot && censored == 0) {
    shot_chi_square += own.chi_square;
    shot_freedoms += own.samples - 1.0;
  }
  ++pixels;
}

ResponseLeastSquares::ResponseLeastSquares(std::vector<BracketPixel> pixels, const UnitSensor& sensor)
    : pixels_(std::move(pixels)),
      sensor_(sensor),
      parameters_(Vector::Zero(ResponseSpline::kCoefficients)),
      reduced_(ResponseSpline::kCoefficients) {}

int ResponseLeastSquares::run() {
  start();
  return iterate(kSettling, kMostIterations);
}

int ResponseLeastSquares::run_from(const Vector& start) {
  parameters_ = start;
  fix_scale();
  return iterate(0, kMostWithKink);
}

// The first `settling` iterations choose samples and measure the shot noise.
int ResponseLeastSquares::iterate(int settling, int most) {
  for (int iteration = 1; iteration <= most; ++iteration) {
    reduce(iteration <= settling);
    if (reduced_.pixels < kFewestPixels || !take_step()) return 0;
    if (gain_ < kConverged && iteration > settling) return iteration;
  }
  return 0;
}

void ResponseLeastSquares::reduce(bool settles) {
  const ResponseSpline curve(parameters_);
  for (BracketPixel& pixel : pixels_) {
    improve_rate(curve, pixel);
    if (settles) choose(curve, pixel);
  }
  reduced_ = ReducedEquations(parameters_.size());
  for (const BracketPixel& pixel : pixels_) reduced_.add(curve, sensor_, pixel);
  if (settles) measure_shot_noise();
}

bool ResponseLeastSquares::take_step() {
  const Eigen::Index n = parameters_.size();
  const Vector without_bends = reduced_.right - kink_prior(n) * parameters_;
  bend_sigma_ = likeliest_bend_sigma(regular() - bend_prior(n, bend_sigma_), without_bends, parameters_, bend_sigma_);
  const Vector slope = without_bends - bend_prior(n, bend_sigma_) * parameters_;
  Vector step = regular().ldlt().solve(slope);
  if (!step.allFinite()) return false;
  double most = std::max(1e-300, step.head<ResponseSpline::kCoefficients>().cwiseAbs().maxCoeff());
  for (Eigen::Index k = ResponseSpline::kCoefficients + 1; k < step.size(); k += ResponseSpline::kOfKink)
    most = std::max(most, std::abs(step[k]) / kFarthestMove);
  step *= std::min(1.0, 1.0 / most);
  parameters_ += step;
  fix_scale();
  // In units of chi-square: a coefficient that the samples do not know may move on for ever.
  gain_ = slope.dot(step);
  return true;
}

// Laplace's approximation. The scale, of which nothing is known, adds the same to every model but for the weight that
// holds it; without that the determinant would be zero.
double ResponseLeastSquares::surprise() const {
  const Eigen::Index n = parameters_.size();
  const double known = regular().ldlt().vectorD().array().log().sum() - std::log(scale_weight());
  const double expected = parameters_.dot((bend_prior(n, bend_sigma_) + kink_prior(n)) * parameters_) +
                          kBendsSeen * std::pow(kTypicalBend / bend_sigma_, 2) +
                          2.0 * (kBends + kBendsSeen) * std::log(bend_sigma_);
  const double of_kink = 2.0 * std::log(kKinkBend) - std::log(2.0 * std::numbers::pi);
  return reduced_.surprise + known + expected + kinks() * of_kink;
}

double ResponseLeastSquares::residual_scale() const {
  const double freedoms = reduced_.samples - reduced_.pixels - static_cast<double>(parameters_.size()) + 1.0;
  return std::sqrt(reduced_.chi_square / std::max(1.0, freedoms));
}

double ResponseLeastSquares::scale_weight() const { return 10.0 * reduced_.normal.trace() + 1.0; }

ResponseMatrix ResponseLeastSquares::covariance() const { return regular().inverse(); }

// The scale is nothing that the samples know: what is added here keeps it at the reference, and changes nothing else.
// Of a kink without a bend they do not know the place; it may be anywhere.
ResponseMatrix ResponseLeastSquares::regular() const {
  const ResponseSpline curve(parameters_);
  const Vector scale = curve.linear_gradient(kReference) / curve.linear(kReference);
  const Eigen::Index n = parameters_.size();
  ResponseMatrix sum =
      reduced_.normal + bend_prior(n, bend_sigma_) + kink_prior(n) + scale_weight() * scale * scale.transpose();
  for (Eigen::Index k = ResponseSpline::kCoefficients + 1; k < n; k += ResponseSpline::kOfKink) sum(k, k) += 1.0;
  return sum;
}

// electrons_per_dn is that of a linear sensor. What a unit of the linear value is here, only the residuals know.
void ResponseLeastSquares::measure_shot_noise() {
  shot_measured_ = reduced_.shot_freedoms > kFewestFreedoms;
  if (shot_measured_) sensor_.shot *= std::clamp(reduced_.shot_chi_square / reduced_.shot_freedoms, 0.5, 2.0);
}

void ResponseLeastSquares::fix_scale() {
  const double factor = kReference / ResponseSpline(parameters_).linear(kReference);
  parameters_.head<ResponseSpline::kCoefficients>().array() += std::log(factor);
}

void ResponseLeastSquares::start() {
  parameters_ = starting_curve(pixels_, sensor_);
  fix_scale();
  const ResponseSpline curve(parameters_);
  for (BracketPixel& pixel : pixels_) {
    double light = 0.0, time_s = 0.0;
    for (const PixelSample& sample : pixel.samples) {
      if (!sample.counts) continue;
      light += curve.linear(std::max(sample.u, 0.0));
      time_s += sample.time_s;
    }
    pixel.rate = time_s > 0.0 ? std::max(light / time_s, 1e-12) : 0.0;
  }
}

// Samples by what the pixel's other samples predict: a choice in which a sample's own noise has a say prefers one sign
// of it.
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
  double chosen_normal = 0.0;
  int count = 0, seen = 0;
  for (std::size_t k = 0; k < pixel.samples.size(); ++k) {
    PixelSample& sample = pixel.samples[k];
    const double others = normal - normals[k];
    const double rate = others > 1e-9 * normal ? pixel.rate + (right - rights[k]) / others : pixel.rate;
    const LinearisedSample at = linearised(curve, sensor_, sample, pixel.rate);
    const bool fits = sample.censored || at.residual * at.residual * at.weight < kOutlierSigmas * kOutlierSigmas;
    sample.counts = rate * sample.time_s > kDimmestElectrons * sensor_.shot && fits;
    if (!sample.counts) continue;
    chosen_normal += at.weight * at.by_rate * at.by_rate;
    ++count;
    seen += sample.censored ? 0 : 1;
  }
  pixel.tells = count >= 2 && seen > 0 && chosen_normal * pixel.rate * pixel.rate > kFewestElectrons;
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
