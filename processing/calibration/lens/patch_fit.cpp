#include "processing/calibration/lens/patch_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

bool is_green(Mosaic mosaic, int x, int y) { return mosaic == Mosaic::Mono || mosaic_channel(mosaic, x, y) == 1; }

struct NormalEquations {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd descent;  // J^T W r
  double chi2 = 0;
};

NormalEquations linearised(const std::vector<PatchSample>& samples, const Eigen::VectorXd& at, bool weighted,
                           const PatchModel& model) {
  const Eigen::Index n = at.size();
  NormalEquations result{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0};
  Eigen::VectorXd gradient(n);
  for (const PatchSample& sample : samples) {
    const double residual = sample.value - model(sample, at, gradient);
    const double weight = weighted ? 1.0 / (sample.sigma * sample.sigma) : 1.0;
    result.hessian.selfadjointView<Eigen::Lower>().rankUpdate(gradient, weight);
    result.descent += weight * residual * gradient;
    result.chi2 += weight * residual * residual;
  }
  result.hessian = result.hessian.selfadjointView<Eigen::Lower>();
  return result;
}

// The inverse by way of unit diagonal: pixels, radians and radiances differ by many orders of magnitude.
std::optional<Eigen::MatrixXd> scaled_inverse(const Eigen::MatrixXd& hessian) {
  if (!(hessian.diagonal().minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXd scale = hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> factor(scale.asDiagonal() * hessian * scale.asDiagonal());
  constexpr double kLeastPivot = 1e-10;
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > kLeastPivot)) return std::nullopt;
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace

std::vector<PatchSample> patch_samples(const MosaicRadiance& image, const Eigen::Vector2d& least,
                                       const Eigen::Vector2d& most) {
  const auto first = [](double bound) { return static_cast<int>(std::ceil(std::clamp(bound, -1e6, 1e6) - 0.5)); };
  const auto last = [](double bound) { return static_cast<int>(std::floor(std::clamp(bound, -1e6, 1e6) - 0.5)); };
  std::vector<PatchSample> samples;
  for (int y = std::max(0, first(least.y())); y <= std::min(image.height - 1, last(most.y())); ++y) {
    for (int x = std::max(0, first(least.x())); x <= std::min(image.width - 1, last(most.x())); ++x) {
      const std::size_t i = image.index(x, y);
      if (!is_green(image.mosaic, x, y) || (image.flags[i] & kUnusablePixel) || !std::isfinite(image.value[i]))
        continue;
      const double variance = image.variance[i];
      samples.push_back({{x + 0.5, y + 0.5}, image.value[i], variance > 0.0 ? std::sqrt(variance) : 0.0, 0});
    }
  }
  return samples;
}

std::optional<PatchFit> fit_patch(const std::vector<PatchSample>& samples, const Eigen::VectorXd& start,
                                  const PatchModel& model) {
  const auto excess = static_cast<double>(samples.size()) - static_cast<double>(start.size());
  if (excess < 1.0) return std::nullopt;
  const bool weighted = std::all_of(samples.begin(), samples.end(), [](const auto& s) { return s.sigma > 0.0; });
  Eigen::VectorXd at = start;
  NormalEquations now = linearised(samples, at, weighted, model);
  double damping = 1e-3;
  bool converged = false;
  constexpr int kMostSteps = 40;
  for (int step = 0; step < kMostSteps && !converged; ++step) {
    Eigen::MatrixXd damped = now.hessian;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd move = damped.ldlt().solve(now.descent);
    if (!move.allFinite()) return std::nullopt;
    NormalEquations next = linearised(samples, at + move, weighted, model);
    constexpr double kWorseByRounding = 1e-9;
    if (std::isfinite(next.chi2) && next.chi2 <= now.chi2 * (1.0 + kWorseByRounding)) {
      // A gain of chi square far below 1 is a move far below one sigma. Without sigmas its unit is the residuals' own.
      const double unit = weighted ? 1.0 : now.chi2 / excess;
      converged = move.dot(now.descent) <= 1e-6 * unit;
      at += move;
      now = std::move(next);
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping *= 10.0;
      // No step, however small, makes it better: a minimum, if one with a kink.
      converged = damping > 1e8;
    }
  }
  if (!converged) return std::nullopt;
  auto covariance = scaled_inverse(now.hessian);
  if (!covariance) return std::nullopt;
  const double reduced = now.chi2 / excess;
  return PatchFit{at, *covariance * (weighted ? std::max(1.0, reduced) : reduced), reduced};
}

double normal_integral(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }
double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi); }

}  // namespace lumitexel
