#include "processing/calibration/light/highlight_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

// The profile is an approximation. Without these as errors, part of the value itself and part of the brightest, the
// core would outvote the flanks and, by its small noise, the far skirt both.
constexpr double kProfileError = 0.03, kSkirtError = 0.005;
constexpr int kSubsamples = 3;  // per axis and pixel: the peak is hardly wider than a pixel

struct Sample {
  double x = 0, y = 0, value = 0, sigma = 1;  // centre of the pixel
  double noise = 1;                           // the part of sigma that is the pixel's own
  int channel = 0;
};

// centre x, y; L: l11, l21, l22; shape; background; then one amplitude, or one per colour.
using Parameters = Eigen::VectorXd;
constexpr Eigen::Index kShape = 5, kBackground = 6, kFirstAmplitude = 7;

// The exponent, kept between heavier tails than any mirror's and what no pixel can tell from a Gaussian.
double exponent_of(double shape) { return 1.0 + 15.0 / (1.0 + std::exp(-shape)); }
double exponent_slope_of(double shape) {
  const double above = exponent_of(shape) - 1.0;
  return above * (1.0 - above / 15.0);
}
constexpr double kStartShape = -2.64;  // exponent 2, a GGX surface's

// What is known of the shape beforehand.
struct ShapePrior {
  double start = kStartShape;
  double sigma = 2.0;  // weak: where the pixels cannot tell, the start stays
};
ShapePrior shape_prior(const std::optional<double>& exponent) {
  if (!exponent) return {};
  constexpr double kHeld = 1e-4;
  return {-std::log(15.0 / (*exponent - 1.0) - 1.0), kHeld};
}

// Where the peak lives: t(p) = (across_x . u(p), across_y . u(p)), u fixed for a place in the picture, the two rows
// following the centre. In the picture's plane u = (x, y, 1); on a sphere u is the normal.
class Domain {
 public:
  explicit Domain(const HighlightShape& shape) : sphere_(shape.sphere), peaks_(shape.peaks) {
    if (peaks_.empty()) peaks_.emplace_back();
    double sum = 0.0;
    for (const HighlightPeak& peak : peaks_) sum += peak.share;
    for (HighlightPeak& peak : peaks_) peak.share /= sum;
  }
  const std::vector<HighlightPeak>& peaks() const { return peaks_; }

  struct Place {
    Eigen::Vector3d u;
    double weight;
  };
  std::optional<Place> at(double x, double y) const {
    if (!sphere_) return Place{{x, y, 1.0}, 1.0};
    const Eigen::Vector3d view = sphere_->camera.unproject({x, y});
    const auto mirrored = mirrored_ray(sphere_->sphere, {Eigen::Vector3d::Zero(), view});
    if (!mirrored) return std::nullopt;
    const Eigen::Vector3d normal = (mirrored->origin - sphere_->sphere.centre) / sphere_->sphere.radius_m;
    // At the rim the model's 1 / cosine has no bound; shadowing, which it leaves out, would take it back.
    constexpr double kLeastCosine = 0.1;
    return Place{normal, 1.0 / std::max(kLeastCosine, -normal.dot(view))};
  }

  using Rows = Eigen::Matrix<double, 2, 3>;
  std::optional<Rows> rows(double centre_x, double centre_y) const {
    Rows rows;
    if (!sphere_) {
      rows << 1.0, 0.0, -centre_x, 0.0, 1.0, -centre_y;
      return rows;
    }
    const auto centre = at(centre_x, centre_y);
    if (!centre) return std::nullopt;
    const double radius_px = sphere_->camera.focal_x_px * sphere_->sphere.radius_m / sphere_->sphere.centre.z();
    const Eigen::Vector3d n0 = centre->u;
    const Eigen::Vector3d across = (Eigen::Vector3d::UnitX() - n0.x() * n0).normalized();
    rows.row(0) = radius_px * across.transpose();
    rows.row(1) = radius_px * n0.cross(across).transpose();
    return rows;
  }

 private:
  std::optional<SphereInView> sphere_;
  std::vector<HighlightPeak> peaks_;
};

class PeakModel {
 public:
  PeakModel(const std::vector<Sample>& samples, const std::optional<ColourBalance>& balance, const Domain& domain,
            const ShapePrior& prior)
      : balance_(balance), domain_(domain), prior_(prior) {
    for (const Sample& sample : samples) add(sample);
  }
  std::size_t size() const { return samples_.size(); }

  // Variance of every residual by its pixel's noise alone.
  Eigen::VectorXd noise_shares() const {
    Eigen::VectorXd shares(static_cast<Eigen::Index>(samples_.size()) + 1);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      shares[static_cast<Eigen::Index>(i)] = std::pow(samples_[i].noise / samples_[i].sigma, 2);
    }
    shares[shares.size() - 1] = 1.0;  // the prior of the shape
    return shares;
  }

  // Not finite where the centre has left the sphere.
  Eigen::VectorXd residuals(const Parameters& p) const { return residuals(p, profiles(p)); }

  Eigen::MatrixXd jacobian(const Parameters& p) const {
    const auto size = static_cast<Eigen::Index>(samples_.size());
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(size + 1, p.size());
    j(size, kShape) = 1.0 / prior_.sigma;
    const auto rows = domain_.rows(p[0], p[1]);
    const auto along_x = rows_slope(p, 0), along_y = rows_slope(p, 1);
    if (!rows || !along_x || !along_y) return j.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index i = 0; i < size; ++i) {
      const Sample& s = samples_[static_cast<std::size_t>(i)];
      const double scale = gain(s) / s.sigma;
      const Slopes profile = slopes_at(p, *rows, *along_x, *along_y, static_cast<std::size_t>(i));
      j.row(i).head<kBackground>() = scale * p[amplitude_index(s)] * profile.by.transpose();
      j(i, kBackground) = scale;  // background and amplitudes enter linearly
      j(i, amplitude_index(s)) = scale * profile.value;
    }
    return j;
  }

 private:
  static constexpr std::size_t kPlaces = kSubsamples * kSubsamples;

  double gain(const Sample& s) const { return balance_ ? (*balance_)[static_cast<std::size_t>(s.channel)] : 1.0; }
  Eigen::Index amplitude_index(const Sample& s) const { return kFirstAmplitude + (balance_ ? 0 : s.channel); }

  Eigen::VectorXd residuals(const Parameters& p, const Eigen::VectorXd& profile) const {
    Eigen::VectorXd r(profile.size() + 1);
    r[profile.size()] = (p[kShape] - prior_.start) / prior_.sigma;
    for (Eigen::Index i = 0; i < profile.size(); ++i) {
      const Sample& s = samples_[static_cast<std::size_t>(i)];
      r[i] = (gain(s) * (p[kBackground] + p[amplitude_index(s)] * profile[i]) - s.value) / s.sigma;
    }
    return r;
  }

  Eigen::VectorXd profiles(const Parameters& p) const {
    Eigen::VectorXd result(static_cast<Eigen::Index>(samples_.size()));
    const auto rows = domain_.rows(p[0], p[1]);
    if (!rows) return result.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < samples_.size(); ++i) result[static_cast<Eigen::Index>(i)] = profile_at(p, *rows, i);
    return result;
  }

  void add(const Sample& sample) {
    std::array<Domain::Place, kPlaces> places;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const double dx = (static_cast<double>(i % kSubsamples) + 0.5) / kSubsamples - 0.5;
      const double dy = (static_cast<double>(i / kSubsamples) + 0.5) / kSubsamples - 0.5;
      const auto place = domain_.at(sample.x + dx, sample.y + dy);
      if (!place) return;  // off the sphere
      places[i] = *place;
    }
    samples_.push_back(sample);
    places_.insert(places_.end(), places.begin(), places.end());
  }

  double profile_at(const Parameters& p, const Domain::Rows& rows, std::size_t sample) const {
    const double exponent = exponent_of(p[kShape]);
    double sum = 0.0;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const Domain::Place& place = places_[sample * kPlaces + i];
      const Eigen::Vector2d from_centre = rows * place.u;
      for (const HighlightPeak& peak : domain_.peaks()) {
        const Eigen::Vector2d t = from_centre - peak.offset_px;
        const double a = p[2] * t.x(), b = p[3] * t.x() + p[4] * t.y();
        sum += peak.share * place.weight * std::pow(1.0 + (a * a + b * b) / exponent, -exponent);
      }
    }
    return sum / static_cast<double>(kPlaces);
  }

  // Of the rows by one coordinate of the centre: a central difference, since on a sphere they follow it by a long way round.
  std::optional<Domain::Rows> rows_slope(const Parameters& p, Eigen::Index coordinate) const {
    const double step = 1e-5 * std::max(std::abs(p[coordinate]), 0.1);
    Eigen::Vector2d up = p.head<2>(), down = up;
    up[coordinate] += step;
    down[coordinate] -= step;
    const auto above = domain_.rows(up.x(), up.y()), below = domain_.rows(down.x(), down.y());
    if (!above || !below) return std::nullopt;
    return (*above - *below) / (2.0 * step);
  }

  struct Slopes {
    double value = 0;
    Eigen::Matrix<double, kBackground, 1> by = Eigen::Matrix<double, kBackground, 1>::Zero();  // centre, L, shape
  };

  // profile_at with its derivatives; along_x, along_y: of the rows by the centre.
  Slopes slopes_at(const Parameters& p, const Domain::Rows& rows, const Domain::Rows& along_x, const Domain::Rows& along_y,
                   std::size_t sample) const {
    const double exponent = exponent_of(p[kShape]), exponent_slope = exponent_slope_of(p[kShape]);
    Slopes slopes;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const Domain::Place& place = places_[sample * kPlaces + i];
      const Eigen::Vector2d from_centre = rows * place.u, by_x = along_x * place.u, by_y = along_y * place.u;
      for (const HighlightPeak& peak : domain_.peaks()) {
        const Eigen::Vector2d t = from_centre - peak.offset_px;
        const double a = p[2] * t.x(), b = p[3] * t.x() + p[4] * t.y();
        const double base = 1.0 + (a * a + b * b) / exponent;
        const double value = peak.share * place.weight * std::pow(base, -exponent);
        const double by_a = -2.0 * a * value / base, by_b = -2.0 * b * value / base;
        const Eigen::Vector2d by_t(by_a * p[2] + by_b * p[3], by_b * p[4]);
        slopes.value += value;
        slopes.by[0] += by_t.dot(by_x);
        slopes.by[1] += by_t.dot(by_y);
        slopes.by[2] += by_a * t.x();
        slopes.by[3] += by_b * t.x();
        slopes.by[4] += by_b * t.y();
        slopes.by[kShape] += exponent_slope * value * ((base - 1.0) / base - std::log(base));
      }
    }
    slopes.value /= static_cast<double>(kPlaces);
    slopes.by /= static_cast<double>(kPlaces);
    return slopes;
  }

  std::optional<ColourBalance> balance_;
  Domain domain_;
  ShapePrior prior_;
  std::vector<Sample> samples_;
  std::vector<Domain::Place> places_;  // kPlaces for each sample
};

bool nearer_to_another(const Eigen::Vector2d& pixel, const Eigen::Vector2d& start, const std::vector<Eigen::Vector2d>& others) {
  return std::any_of(others.begin(), others.end(), [&](const Eigen::Vector2d& other) {
    return (pixel - other).squaredNorm() < (pixel - start).squaredNorm();
  });
}

std::vector<Sample> usable_samples(const MosaicRadiance& image, const Eigen::Vector2d& start, int reach_px,
                                   const std::vector<Eigen::Vector2d>& others) {
  std::vector<Sample> samples;
  double brightest = 0.0;
  const int cx = static_cast<int>(std::floor(start.x())), cy = static_cast<int>(std::floor(start.y()));
  for (int y = std::max(0, cy - reach_px); y <= std::min(image.height - 1, cy + reach_px); ++y) {
    for (int x = std::max(0, cx - reach_px); x <= std::min(image.width - 1, cx + reach_px); ++x) {
      const std::size_t i = image.index(x, y);
      if (image.flags[i] & (kPixelSaturated | kPixelDefective)) continue;
      if (nearer_to_another({x + 0.5, y + 0.5}, start, others)) continue;
      const double value = image.value[i];
      brightest = std::max(brightest, value);
      const double variance = image.variance[i];
      samples.push_back({x + 0.5, y + 0.5, value, std::sqrt(variance + std::pow(kProfileError * value, 2)), std::sqrt(variance),
                         mosaic_channel(image.mosaic, x, y)});
    }
  }
  for (Sample& sample : samples) sample.sigma = std::hypot(sample.sigma, kSkirtError * brightest);
  return samples;
}

Parameters start_values(const std::vector<Sample>& samples, const Eigen::Vector2d& start, double start_shape, bool one_amplitude) {
  std::vector<double> values;
  for (const Sample& s : samples) values.push_back(s.value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double background = *middle, peak = *std::max_element(values.begin(), values.end());
  Parameters p = Parameters::Zero(kFirstAmplitude + (one_amplitude ? 1 : 3));
  constexpr double kStartWidthPx = 1.5;
  p << start, 1.0 / kStartWidthPx, 0.0, 1.0 / kStartWidthPx, start_shape, background,
      Eigen::VectorXd::Constant(p.size() - kFirstAmplitude, 1.5 * (peak - background));
  return p;
}

// Levenberg-Marquardt; true once a nearly undamped step would not move the centre by more than 1e-4 px.
bool minimise(const PeakModel& model, Parameters& p) {
  double damping = 1e-3;
  Eigen::VectorXd r = model.residuals(p);
  constexpr int kMaxIterations = 60;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::MatrixXd j = model.jacobian(p);
    const Eigen::MatrixXd normal = j.transpose() * j;
    const Eigen::VectorXd gradient = j.transpose() * r;
    bool improved = false;
    for (; !improved && damping < 1e9; damping *= improved ? 0.1 : 10.0) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const Eigen::VectorXd step = damped.ldlt().solve(gradient);
      const Eigen::VectorXd candidate_r = model.residuals(p - step);
      improved = candidate_r.allFinite() && candidate_r.squaredNorm() < r.squaredNorm();
      if (improved) {
        p -= step;
        r = candidate_r;
      }
      // Also without improvement: at the minimum, rounding decides about that.
      if (step.head<2>().norm() < 1e-4 && damping < 0.1) return true;
    }
    if (!improved) return false;
  }
  return false;
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& normal) {
  // Scaled to unit diagonal first: amplitudes and pixels differ by many orders of magnitude.
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  return scale.asDiagonal() * scaled.completeOrthogonalDecomposition().pseudoInverse() * scale.asDiagonal();
}

}  // namespace

double flux_of(const FittedHighlight& fit) {
  return fit.amplitude * std::numbers::pi * fit.width_px * fit.width_px * fit.exponent / (fit.exponent - 1.0);
}

std::optional<Eigen::Vector2d> across_centre(const SphereInView& view, const Eigen::Vector2d& centre_px,
                                             const Eigen::Vector3d& normal) {
  const auto rows = Domain(HighlightShape{.sphere = view}).rows(centre_px.x(), centre_px.y());
  return rows ? std::optional<Eigen::Vector2d>(*rows * normal) : std::nullopt;
}

std::optional<FittedHighlight> fit_highlight(const MosaicRadiance& image, const Eigen::Vector2d& start, int reach_px,
                                             const std::optional<ColourBalance>& balance, const HighlightShape& shape) {
  const bool one_amplitude = balance.has_value() || image.mosaic == Mosaic::Mono;
  const std::optional<ColourBalance> used = image.mosaic == Mosaic::Mono ? ColourBalance{1, 1, 1} : balance;
  const std::vector<Sample> samples = usable_samples(image, start, reach_px, shape.others_px);
  const ShapePrior prior = shape_prior(shape.exponent);
  const PeakModel model(samples, used, Domain(shape), prior);
  constexpr std::size_t kLeastSamples = 20;  // about twice the unknowns
  if (model.size() < kLeastSamples) return std::nullopt;
  Parameters p = start_values(samples, start, prior.start, one_amplitude);
  const auto freedom = static_cast<double>(model.size()) - static_cast<double>(p.size());
  if (!minimise(model, p)) return std::nullopt;
  const Eigen::MatrixXd j = model.jacobian(p);
  // The profile's error sets the weights, but it is no noise: over spheres and views it stays, and what is left of it in the
  // centre is not for this fit to know.
  const Eigen::MatrixXd inverse = pseudo_inverse(j.transpose() * j);
  const Eigen::MatrixXd covariance = inverse * (j.transpose() * model.noise_shares().asDiagonal() * j) * inverse *
                                     std::max(1.0, model.residuals(p).squaredNorm() / freedom);
  FittedHighlight fit;
  fit.pixel = p.head<2>();
  fit.sigma_px = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
  fit.width_px = 1.0 / std::sqrt(std::abs(p[2] * p[4]));
  fit.exponent = exponent_of(p[kShape]);
  Eigen::Matrix2d l;
  l << p[2], 0.0, p[3], p[4];
  fit.spread_px2 = (l.transpose() * l).inverse();
  fit.amplitude = p[one_amplitude ? kFirstAmplitude : kFirstAmplitude + 1];
  if (!one_amplitude) {
    fit.balance = {p[kFirstAmplitude] / fit.amplitude, 1.0, p[kFirstAmplitude + 2] / fit.amplitude};
  } else if (balance) {
    fit.balance = *balance;
  }
  const bool in_picture = fit.pixel.x() > 0.0 && fit.pixel.y() > 0.0 && fit.pixel.x() < image.width && fit.pixel.y() < image.height;
  const bool sane = std::isfinite(fit.sigma_px) && in_picture && fit.amplitude > 0.0 && (fit.pixel - start).norm() < reach_px &&
                    fit.width_px < reach_px;
  return sane ? std::optional(fit) : std::nullopt;
}

}  // namespace lumitexel
