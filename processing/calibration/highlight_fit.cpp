#include "processing/calibration/highlight_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

// The profile is an approximation; without this part of the value as an error, the bright core would outvote the flanks.
constexpr double kProfileError = 0.03;
constexpr int kSubsamples = 4;  // per axis and pixel: the peak is hardly wider than a pixel

struct Sample {
  double x = 0, y = 0, value = 0, sigma = 1;  // centre of the pixel
  int channel = 0;
};

// centre x, y; L: l11, l21, l22; background; then one amplitude, or one per colour.
using Parameters = Eigen::VectorXd;
constexpr Eigen::Index kBackground = 5, kFirstAmplitude = 6;

double profile(const Parameters& p, double x, double y) {
  double sum = 0.0;
  for (int j = 0; j < kSubsamples; ++j) {
    for (int i = 0; i < kSubsamples; ++i) {
      const double dx = x + (i + 0.5) / kSubsamples - 0.5 - p[0], dy = y + (j + 0.5) / kSubsamples - 0.5 - p[1];
      const double a = p[2] * dx, b = p[3] * dx + p[4] * dy;
      const double q = 1.0 + a * a + b * b;
      sum += 1.0 / (q * q);
    }
  }
  return sum / (kSubsamples * kSubsamples);
}

class PeakModel {
 public:
  PeakModel(std::vector<Sample> samples, const std::optional<ColourBalance>& balance)
      : samples_(std::move(samples)), balance_(balance) {}

  Eigen::VectorXd residuals(const Parameters& p) const {
    Eigen::VectorXd r(static_cast<Eigen::Index>(samples_.size()));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& s = samples_[i];
      const auto c = static_cast<std::size_t>(s.channel);
      const double gain = balance_ ? (*balance_)[c] : 1.0;
      const double amplitude = p[kFirstAmplitude + (balance_ ? 0 : s.channel)];
      r[static_cast<Eigen::Index>(i)] = (gain * (p[kBackground] + amplitude * profile(p, s.x, s.y)) - s.value) / s.sigma;
    }
    return r;
  }

  Eigen::MatrixXd jacobian(const Parameters& p) const {
    Eigen::MatrixXd j(static_cast<Eigen::Index>(samples_.size()), p.size());
    for (Eigen::Index k = 0; k < p.size(); ++k) {
      const double step = 1e-5 * std::max(std::abs(p[k]), k < kBackground ? 0.1 : 1.0);
      Parameters up = p, down = p;
      up[k] += step;
      down[k] -= step;
      j.col(k) = (residuals(up) - residuals(down)) / (2.0 * step);
    }
    return j;
  }

 private:
  std::vector<Sample> samples_;
  std::optional<ColourBalance> balance_;
};

std::vector<Sample> usable_samples(const MosaicRadiance& image, const Eigen::Vector2d& start, int reach_px) {
  std::vector<Sample> samples;
  const int cx = static_cast<int>(std::floor(start.x())), cy = static_cast<int>(std::floor(start.y()));
  for (int y = std::max(0, cy - reach_px); y <= std::min(image.height - 1, cy + reach_px); ++y) {
    for (int x = std::max(0, cx - reach_px); x <= std::min(image.width - 1, cx + reach_px); ++x) {
      const std::size_t i = image.index(x, y);
      if (image.flags[i] & (kPixelSaturated | kPixelDefective)) continue;
      const double value = image.value[i];
      samples.push_back({x + 0.5, y + 0.5, value, std::sqrt(image.variance[i] + std::pow(kProfileError * value, 2)),
                         mosaic_channel(image.mosaic, x, y)});
    }
  }
  return samples;
}

Parameters start_values(const std::vector<Sample>& samples, const Eigen::Vector2d& start, bool one_amplitude) {
  std::vector<double> values;
  for (const Sample& s : samples) values.push_back(s.value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double background = *middle, peak = *std::max_element(values.begin(), values.end());
  Parameters p = Parameters::Zero(kFirstAmplitude + (one_amplitude ? 1 : 3));
  constexpr double kStartWidthPx = 1.5;
  p << start, 1.0 / kStartWidthPx, 0.0, 1.0 / kStartWidthPx, background,
      Eigen::VectorXd::Constant(p.size() - kFirstAmplitude, 1.5 * (peak - background));
  return p;
}

// Levenberg-Marquardt; true once a step no longer moves the centre by more than 1e-5 px.
bool minimise(const PeakModel& model, Parameters& p) {
  double damping = 1e-3;
  Eigen::VectorXd r = model.residuals(p);
  constexpr int kMaxIterations = 60;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::MatrixXd j = model.jacobian(p);
    const Eigen::MatrixXd normal = j.transpose() * j;
    const Eigen::VectorXd gradient = j.transpose() * r;
    while (damping < 1e12) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const Eigen::VectorXd step = damped.ldlt().solve(gradient);
      const Parameters candidate = p - step;
      const Eigen::VectorXd candidate_r = model.residuals(candidate);
      if (candidate_r.allFinite() && candidate_r.squaredNorm() <= r.squaredNorm()) {
        const bool settled = step.head<2>().norm() < 1e-5 && damping < 1.0;
        p = candidate;
        r = candidate_r;
        damping = std::max(damping * 0.1, 1e-9);
        if (settled) return true;
        break;
      }
      damping *= 10.0;
    }
    if (damping >= 1e12) return false;
  }
  return false;
}

}  // namespace

std::optional<FittedHighlight> fit_highlight(const MosaicRadiance& image, const Eigen::Vector2d& start, int reach_px,
                                             const std::optional<ColourBalance>& balance) {
  const bool one_amplitude = balance.has_value() || image.mosaic == Mosaic::Mono;
  const std::optional<ColourBalance> used = image.mosaic == Mosaic::Mono ? ColourBalance{1, 1, 1} : balance;
  std::vector<Sample> samples = usable_samples(image, start, reach_px);
  const std::size_t kLeastSamples = 20;  // about twice the unknowns
  if (samples.size() < kLeastSamples) return std::nullopt;
  Parameters p = start_values(samples, start, one_amplitude);
  const auto freedom = static_cast<double>(samples.size()) - static_cast<double>(p.size());
  const PeakModel model(std::move(samples), used);
  if (!minimise(model, p)) return std::nullopt;
  const Eigen::MatrixXd j = model.jacobian(p);
  const Eigen::MatrixXd covariance = (j.transpose() * j).inverse() * std::max(1.0, model.residuals(p).squaredNorm() / freedom);
  FittedHighlight fit;
  fit.pixel = p.head<2>();
  fit.sigma_px = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
  fit.width_px = 1.0 / std::sqrt(std::abs(p[2] * p[4]));
  fit.amplitude = p[one_amplitude ? kFirstAmplitude : kFirstAmplitude + 1];
  if (!one_amplitude) {
    fit.balance = {p[kFirstAmplitude] / fit.amplitude, 1.0, p[kFirstAmplitude + 2] / fit.amplitude};
  } else if (balance) {
    fit.balance = *balance;
  }
  const bool sane = std::isfinite(fit.sigma_px) && fit.amplitude > 0.0 && (fit.pixel - start).norm() < reach_px &&
                    fit.width_px < reach_px;
  return sane ? std::optional(fit) : std::nullopt;
}

}  // namespace lumitexel
