#include "processing/image/fit_response.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "drivers/error.h"
#include "processing/image/response_spline.h"

namespace lumitexel {
namespace {

using Vector = ResponseSpline::Vector;
using Matrix = Eigen::Matrix<double, ResponseSpline::kCoefficients, ResponseSpline::kCoefficients>;

constexpr int kMostPixels = 160'000, kFewestPixels = 200, kMostIterations = 40;
constexpr int kCandidates = 600'000;
constexpr int kSettling = 6;                // iterations that choose samples and measure the shot noise; then both stay
constexpr double kShotDominates = 1.0;      // over all other variance
constexpr double kFewestFreedoms = 1000.0;  // to measure shot noise to 5 %
constexpr double kCertainSigmas = 5.0;      // a censored sample expected so far above the bound tells nothing
constexpr double kDimmest = 12.0;           // electrons: below, more than the second derivative bends the mean code
constexpr double kSmooth = 400.0;           // electrons: from here on a curve is a parabola within the shot noise
constexpr double kFewestElectrons =
    600.0;  // of a pixel: each rate is fitted as well, which bends the curve by some 1 / this
constexpr double kOutlierSigmas = 6.0;
constexpr double kBendSigma = 0.06;  // prior on second differences of the log slope: sRGB's kink is about twice that
constexpr double kConverged = 0.01;
constexpr double kWorstRelativeSigma = 0.05;
constexpr int kPoints = 65;
constexpr double kReference = 0.5;

struct Sample {
  double u, time_s;
  bool censored;  // not below the bound: only that is known
  bool counts;
};
struct Pixel {
  std::vector<Sample> samples;  // codes in units of the range, over black
  double rate;                  // linear value in units of the range, per second
};

struct Scaled {                          // the sensor in units of its range
  double range_dn, usable, shot, reads;  // usable: the lower edge of the least censored code
  explicit Scaled(const LinearSensor& sensor) : range_dn(sensor.clip_dn - sensor.black_level_dn) {
    usable = (std::ceil(sensor.usable_below_dn()) - 0.5 - sensor.black_level_dn) / range_dn;
    shot = 1.0 / (sensor.electrons_per_dn * range_dn);
    reads = sensor.variance_dn2(0.0) / (range_dn * range_dn);
  }
};

void check_bracket(const std::vector<Frame>& bracket) {
  double shortest_s = 0.0, longest_s = 0.0;
  for (const Frame& frame : bracket) {
    const double exposure_s = frame.reported.exposure_s;
    if (frame.samples.size() != bracket[0].samples.size()) {
      throw BadInput("response", "frames of different size in one bracket", "exposures by one camera");
    }
    if (!(exposure_s > 0.0) || !std::isfinite(exposure_s)) {
      throw BadInput("response", "an exposure of " + std::to_string(exposure_s) + " s", "a positive time");
    }
    shortest_s = shortest_s == 0.0 ? exposure_s : std::min(shortest_s, exposure_s);
    longest_s = std::max(longest_s, exposure_s);
  }
  if (!(longest_s > shortest_s)) throw BadInput("response", "a bracket of one exposure time", "two that differ");
}

Pixel pixel_of(const std::vector<Frame>& bracket, std::size_t i, const LinearSensor& sensor, const Scaled& scaled) {
  Pixel pixel{{}, 0.0};
  double sum = 0.0, time_s = 0.0;
  for (const Frame& frame : bracket) {
    const double u = (frame.samples[i] - sensor.black_level_dn) / scaled.range_dn;
    const bool censored = u >= scaled.usable;
    pixel.samples.push_back({u, frame.reported.exposure_s, censored, !censored});
    if (censored) continue;
    sum += u;
    time_s += frame.reported.exposure_s;
  }
  pixel.rate = time_s > 0.0 ? sum / time_s : 0.0;
  return pixel;
}

// Pixels of every brightness alike, so that the curve is known everywhere: a scene is mostly dark.
std::vector<Pixel> chosen_pixels(const std::vector<std::vector<Frame>>& brackets, const LinearSensor& sensor,
                                 const Scaled& scaled) {
  std::map<int, std::vector<Pixel>> by_brightness;
  std::size_t candidates = 0;
  for (const std::vector<Frame>& bracket : brackets) {
    check_bracket(bracket);
    const std::size_t share = kCandidates / brackets.size() + 1;
    const std::size_t stride = std::max<std::size_t>(1, bracket[0].samples.size() / share) | 1u;  // odd: all colours
    for (std::size_t i = 0; i < bracket[0].samples.size(); i += stride) {
      Pixel pixel = pixel_of(bracket, i, sensor, scaled);
      if (!(pixel.rate > 0.0)) continue;
      by_brightness[static_cast<int>(std::floor(4.0 * std::log2(pixel.rate)))].push_back(std::move(pixel));
      ++candidates;
    }
  }
  std::vector<Pixel> chosen;
  if (candidates == 0) return chosen;
  const std::size_t quota = kMostPixels / by_brightness.size() + 1;
  for (auto& [brightness, pixels] : by_brightness) {
    const std::size_t stride = (pixels.size() + quota - 1) / quota;
    for (std::size_t i = 0; i < pixels.size(); i += stride) chosen.push_back(std::move(pixels[i]));
  }
  return chosen;
}

// The normal equations of the curve, every rate eliminated.
struct Reduced {
  Matrix normal = Matrix::Zero();
  Vector right = Vector::Zero();
  double chi_square = 0, samples = 0, lowest = 1, highest = 0;
  int pixels = 0;
  double shot_chi_square = 0, shot_freedoms = 0;  // of pixels whose noise is shot noise before all
};

// A sample about the curve's prediction.
struct Linearised {
  double residual, weight, by_rate, predicted, slope;
};

struct ShotNoise {
  double bend, variance;  // of the code
};

// Density over distribution of the standard normal.
double log_cdf_slope(double a) {
  if (a < -30.0) return -a;
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
  return density / (0.5 * std::erfc(-a / std::numbers::sqrt2));
}

// How much the spline bends, squared: a quadratic form of its coefficients.
Matrix bends() {
  Matrix sum = Matrix::Zero();
  for (int k = 0; k + 2 < ResponseSpline::kCoefficients; ++k) {
    Vector second = Vector::Zero();
    second[k] = second[k + 2] = 1.0;
    second[k + 1] = -2.0;
    sum += second * second.transpose();
  }
  return sum;
}
Matrix prior() { return bends() / (kBendSigma * kBendSigma); }
// What changes the curve's scale and nothing else.
Vector scale_direction() { return Vector::Ones(); }

// See Fit::start. Basis: log u and splines over the square root of u.
Vector starting_curve(const std::vector<Pixel>& pixels, const Scaled& sensor) {
  constexpr int kTerms = ResponseSpline::kCoefficients + 1;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  const auto terms = [](double u) {
    Terms row;
    row << std::log(u), ResponseSpline::basis(u);
    return row;
  };
  Eigen::Matrix<double, kTerms, kTerms> normal = 1e-3 * Eigen::Matrix<double, kTerms, kTerms>::Identity();
  normal.bottomRightCorner<ResponseSpline::kCoefficients, ResponseSpline::kCoefficients>() += bends();
  Terms right = 1e-3 * Terms::Unit(0);  // without any light: a straight line
  double lowest = 1.0;
  for (const Pixel& pixel : pixels) {
    double weights = 0.0, mean_log_s = 0.0;
    Terms mean = Terms::Zero();
    for (int pass = 0; pass < 2; ++pass) {
      for (const Sample& sample : pixel.samples) {
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
  const Terms solution = normal.ldlt().solve(right);
  // From log L to log slope, and that to the spline.
  Matrix fit_normal = 0.1 * bends() + 1e-9 * Matrix::Identity();
  Vector fit_right = Vector::Zero();
  for (int i = 1; i <= 100; ++i) {
    const double u = ResponseSpline::at_place(0.01 * i), delta = 1e-3 * u;
    if (u < lowest) continue;
    const double below = solution.dot(terms(u - delta)), above = solution.dot(terms(std::min(u + delta, 1.0)));
    const double steepness = std::max((above - below) / (std::min(u + delta, 1.0) - u + delta), 0.1 / u);
    const Vector row = ResponseSpline::basis(u);
    fit_normal += row * row.transpose();
    fit_right += row * (solution.dot(terms(u)) + std::log(steepness));
  }
  return fit_normal.ldlt().solve(fit_right);
}

class Fit {
 public:
  Fit(std::vector<Pixel> pixels, const Scaled& sensor) : pixels_(std::move(pixels)), sensor_(sensor) {
    coefficients_.setZero();
  }

  int run() {
    start();
    for (int iteration = 1; iteration <= kMostIterations; ++iteration) {
      const ResponseSpline curve(coefficients_);
      for (Pixel& pixel : pixels_) {
        improve_rate(curve, pixel);
        if (iteration <= kSettling) choose(curve, pixel);
      }
      reduced_ = Reduced{};
      for (const Pixel& pixel : pixels_) add(curve, pixel);
      if (iteration <= kSettling) measure_shot_noise();
      if (reduced_.pixels < kFewestPixels) return 0;
      const Vector slope = reduced_.right - prior() * coefficients_;
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

  const Vector& coefficients() const { return coefficients_; }
  const Reduced& reduced() const { return reduced_; }
  double shot() const { return sensor_.shot; }
  bool shot_measured() const { return shot_measured_; }
  Matrix covariance() const { return regular().inverse(); }

 private:
  // The scale is nothing that the samples know: whatever is added here changes it alone.
  Matrix regular() const {
    return reduced_.normal + prior() +
           (reduced_.normal.trace() / 100.0 + 1.0) * scale_direction() * scale_direction().transpose();
  }

  // electrons_per_dn is that of a linear sensor. What a unit of the linear value is here, only the residuals know.
  void measure_shot_noise() {
    shot_measured_ = reduced_.shot_freedoms > kFewestFreedoms;
    if (shot_measured_) sensor_.shot *= std::clamp(reduced_.shot_chi_square / reduced_.shot_freedoms, 0.5, 2.0);
  }

  void fix_scale() {
    const double factor = kReference / ResponseSpline(coefficients_).linear(kReference);
    coefficients_ += std::log(factor) * scale_direction();
    for (Pixel& pixel : pixels_) pixel.rate *= factor;
  }

  // Debevec and Malik's equations with a curve of few parameters: log L = log rate + log time is linear in them. The
  // errors of dim samples are not what it thinks, so it only starts the rest.
  void start() {
    coefficients_ = starting_curve(pixels_, sensor_);
    const ResponseSpline curve(coefficients_);
    for (Pixel& pixel : pixels_) {
      double light = 0.0, time_s = 0.0;
      for (const Sample& sample : pixel.samples) {
        if (!sample.counts) continue;
        light += curve.linear(std::max(sample.u, 0.0));
        time_s += sample.time_s;
      }
      pixel.rate = time_s > 0.0 ? std::max(light / time_s, 1e-12) : 0.0;
    }
    fix_scale();
  }

  // What shot noise makes of the code at `light`, the code of the mean known. A curve that bends within the noise moves
  // the mean code away from it: by the second derivative, and below kSmooth by Gauss and Hermite's rule, for curves
  // have kinks.
  ShotNoise shot_noise(const ResponseSpline& curve, double light, double code, double slope) const {
    const double variance = sensor_.shot * std::max(light, 0.0);
    const double spread = variance / (slope * slope);
    if (light > kSmooth * sensor_.shot || light < 0.5 * kDimmest * sensor_.shot)
      return {-0.5 * curve.log_slope_slope(code) * spread, spread};
    double mean = 0.0, square = 0.0;
    for (const auto& [sigmas, weight] : {std::pair{1.35562618, 0.22207592}, {2.85697001, 0.01125741}}) {
      for (const double sign : {-1.0, 1.0}) {
        const double off = curve.inverse(light + sign * sigmas * std::sqrt(variance)) - code;
        mean += weight * off;
        square += weight * off * off;
      }
    }
    return {mean, square - mean * mean};
  }

  Linearised linearised(const ResponseSpline& curve, const Sample& sample, double rate) const {
    const double light = rate * sample.time_s;
    Linearised at;
    at.predicted = curve.inverse(light);
    at.slope = curve.slope(at.predicted);
    at.by_rate = sample.time_s / at.slope;
    const auto [bend, spread] = shot_noise(curve, light, at.predicted, at.slope);
    const double variance = sensor_.reads + spread;
    if (!sample.censored) {
      at.residual = sample.u - at.predicted - bend;
      at.weight = 1.0 / variance;
      return at;
    }
    const double a = (at.predicted + bend - sensor_.usable) / std::sqrt(variance), h = log_cdf_slope(a);
    at.weight = a < kCertainSigmas ? h * (h + a) / variance : 0.0;
    at.residual = std::sqrt(variance) / (h + a);
    return at;
  }

  // By what the pixel's other samples predict: a choice in which a sample's own noise has a say prefers one sign of it.
  void choose(const ResponseSpline& curve, Pixel& pixel) const {
    double normal = 0.0, right = 0.0;
    std::vector<double> normals, rights;
    for (const Sample& sample : pixel.samples) {
      const Linearised at = linearised(curve, sample, pixel.rate);
      normals.push_back(sample.counts ? at.weight * at.by_rate * at.by_rate : 0.0);
      rights.push_back(sample.counts ? at.weight * at.by_rate * at.residual : 0.0);
      normal += normals.back();
      right += rights.back();
    }
    for (std::size_t k = 0; k < pixel.samples.size(); ++k) {
      Sample& sample = pixel.samples[k];
      const double others = normal - normals[k];
      const double rate = others > 1e-9 * normal ? pixel.rate + (right - rights[k]) / others : pixel.rate;
      const Linearised at = linearised(curve, sample, pixel.rate);
      const bool fits = sample.censored || at.residual * at.residual * at.weight < kOutlierSigmas * kOutlierSigmas;
      sample.counts = rate * sample.time_s > kDimmest * sensor_.shot && fits;
    }
  }

  void improve_rate(const ResponseSpline& curve, Pixel& pixel) const {
    for (int step = 0; step < 2; ++step) {
      double normal = 0.0, right = 0.0;
      for (const Sample& sample : pixel.samples) {
        if (!sample.counts) continue;
        const Linearised at = linearised(curve, sample, pixel.rate);
        normal += at.weight * at.by_rate * at.by_rate;
        right += at.weight * at.by_rate * at.residual;
      }
      if (normal > 0.0) pixel.rate = std::max(pixel.rate + right / normal, 0.1 * pixel.rate);
    }
  }

  void add(const ResponseSpline& curve, const Pixel& pixel) {
    Matrix own = Matrix::Zero();
    Vector right = Vector::Zero(), mixed = Vector::Zero();
    double normal = 0.0, rate_right = 0.0, chi_square = 0.0;
    int count = 0, seen = 0;
    bool mostly_shot = true;
    for (const Sample& sample : pixel.samples) {
      if (!sample.counts) continue;
      const Linearised at = linearised(curve, sample, pixel.rate);
      const Vector by_curve = -curve.linear_gradient(at.predicted) / at.slope;
      own += at.weight * by_curve * by_curve.transpose();
      right += at.weight * by_curve * at.residual;
      mixed += at.weight * at.by_rate * by_curve;
      normal += at.weight * at.by_rate * at.by_rate;
      rate_right += at.weight * at.by_rate * at.residual;
      if (!sample.censored) chi_square += at.weight * at.residual * at.residual;
      if (!sample.censored) {
        reduced_.lowest = std::min(reduced_.lowest, at.predicted);
        reduced_.highest = std::max(reduced_.highest, std::min(at.predicted, sensor_.usable));
        mostly_shot = mostly_shot && at.weight * sensor_.reads * (1.0 + kShotDominates) < 1.0;
        ++seen;
      }
      ++count;
    }
    if (count < 2 || seen == 0 || normal * pixel.rate * pixel.rate < kFewestElectrons) return;
    reduced_.normal += own - mixed * mixed.transpose() / normal;
    reduced_.right += right - mixed * (rate_right / normal);
    reduced_.chi_square += chi_square;
    reduced_.samples += seen;
    if (mostly_shot && seen == count) {
      reduced_.shot_chi_square += chi_square;
      reduced_.shot_freedoms += seen - 1;
    }
    ++reduced_.pixels;
  }

  std::vector<Pixel> pixels_;
  Scaled sensor_;
  Vector coefficients_;
  Reduced reduced_;
  bool shot_measured_ = false;
};

// Of chi-square with n degrees of freedom, exceeded with 1 %, by Wilson and Hilferty.
double rare_chi_square(int n) {
  const double spread = 2.0 / (9.0 * n);
  return n * std::pow(1.0 - spread + 2.326 * std::sqrt(spread), 3);
}

void state_points(const Fit& fit, const LinearSensor& sensor, const Scaled& scaled, ResponseFit& result) {
  const ResponseSpline curve(fit.coefficients());
  const Matrix covariance = fit.covariance() * std::max(1.0, result.residual_scale * result.residual_scale);
  const Vector at_reference = curve.linear_gradient(kReference) / curve.linear(kReference);
  double sum = 0.0, weights = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double u = std::max(fit.reduced().lowest, 0.0) +
                     (fit.reduced().highest - std::max(fit.reduced().lowest, 0.0)) * std::pow((i + 1.0) / kPoints, 2);
    const Vector slope = curve.linear_gradient(u) / curve.linear(u) - at_reference;
    const double sigma = std::sqrt(slope.dot(covariance * slope));
    result.points.push_back({sensor.black_level_dn + u * scaled.range_dn, curve.linear(u) * scaled.range_dn, sigma});
    const double weight = 1.0 / (sigma * sigma + 1e-8);
    sum += weight * std::log(curve.linear(u) / u);
    weights += weight;
  }
  // Against the straight line that fits best; points that are not known to a negligible part say nothing here.
  for (const ResponsePoint& point : result.points) {
    const double straight = (point.code_dn - sensor.black_level_dn) * std::exp(sum / weights);
    const double departure = std::abs(point.linear_dn / straight - 1.0);
    if (departure > 2.0 * point.relative_sigma)
      result.largest_departure = std::max(result.largest_departure, departure);
  }
}

ResponseCurve tabulated(const Fit& fit, const LinearSensor& sensor, const Scaled& scaled) {
  constexpr int kNodes = 512;
  const ResponseSpline curve(fit.coefficients());
  std::vector<double> codes, linears;
  for (int i = 0; i <= kNodes; ++i) {
    const double u = ResponseSpline::at_place(static_cast<double>(i) / kNodes);
    codes.push_back(sensor.black_level_dn + u * scaled.range_dn);
    linears.push_back(curve.linear(u) * scaled.range_dn);
  }
  return ResponseCurve(std::move(codes), std::move(linears));
}

}  // namespace

ResponseFit fit_response(const std::vector<std::vector<Frame>>& brackets, const LinearSensor& sensor) {
  check_sensor(sensor);
  if (brackets.empty()) throw BadInput("response", "no bracket", "at least one");
  const Scaled scaled(sensor);
  Fit fit(chosen_pixels(brackets, sensor, scaled), scaled);
  ResponseFit result;
  result.iterations = fit.run();
  result.pixels = fit.reduced().pixels;
  if (result.iterations == 0) {
    result.why = result.pixels < kFewestPixels ? "too few pixels with two usable exposures" : "no convergence";
    return result;
  }
  const Reduced& reduced = fit.reduced();
  const double freedoms = reduced.samples - reduced.pixels - ResponseSpline::kCoefficients + 1;
  result.residual_scale = std::sqrt(reduced.chi_square / std::max(1.0, freedoms));
  result.electrons_per_dn = 1.0 / (fit.shot() * scaled.range_dn);
  result.electrons_measured = fit.shot_measured();
  const Matrix known = fit.covariance() * reduced.normal;  // the prior keeps the rest from moving at all
  result.freedoms = std::max(1, static_cast<int>(std::lround((known * known).trace())));
  result.chi_square = fit.coefficients().dot(reduced.normal * fit.coefficients()) /
                      std::max(1.0, result.residual_scale * result.residual_scale);
  state_points(fit, sensor, scaled, result);
  result.determined = result.points[kPoints / 4].relative_sigma < kWorstRelativeSigma &&
                      result.points.back().relative_sigma < kWorstRelativeSigma;
  if (!result.determined) {
    result.why = "the exposures overlap too little to know the curve to 5 %";
  } else if (result.chi_square > rare_chi_square(result.freedoms) && result.largest_departure > kNegligibleCurvature) {
    result.curve = tabulated(fit, sensor, scaled);
  }
  return result;
}

}  // namespace lumitexel
