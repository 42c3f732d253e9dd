#include "processing/calibration/light/lamp_drift.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/error.h"

namespace lumitexel {

struct LampDrift::Hyper {
  double amplitude = 0, length_s = 1, scatter = 0;
};

struct LampDrift::Fit {
  Eigen::MatrixXd inverse;
  Eigen::VectorXd weights;
  double mean = 0, mean_variance = 0, log_likelihood = 0;
};

namespace {

constexpr double kOutlierSigmas = 4.5;
constexpr double kFarOff = 0.3;  // relative: no lamp drifts so far from its own median; a shadow does

double matern(double r) {
  const double s = std::sqrt(5.0) * r;
  return (1.0 + s + s * s / 3.0) * std::exp(-s);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LampDrift::LampDrift(const std::vector<CardSample>& samples) : used_(samples.size(), false) {
  std::vector<double> logs;
  for (const CardSample& sample : samples) {
    if (!(sample.intensity > 0.0) || !(sample.relative_sigma > 0.0) || !std::isfinite(sample.time_s) ||
        !std::isfinite(sample.intensity) || !std::isfinite(sample.relative_sigma)) {
      throw BadInput("lamp drift",
                     "a card sample of intensity " + std::to_string(sample.intensity) + " with relative sigma " +
                         std::to_string(sample.relative_sigma),
                     "finite positive numbers");
    }
    logs.push_back(std::log(sample.intensity));
  }
  if (samples.empty()) return;
  const double middle = median(logs);
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::abs(logs[i] - middle) > kFarOff) continue;
    used_[i] = true;
    index_.push_back(i);
    time_s_.push_back(samples[i].time_s);
    value_.push_back(logs[i]);
    variance_.push_back(samples[i].relative_sigma * samples[i].relative_sigma);
    first = std::min(first, samples[i].time_s);
    last = std::max(last, samples[i].time_s);
  }
  span_s_ = last > first ? last - first : 1.0;
  do choose();
  while (drop_worst());
}

double LampDrift::kernel(double dt_s) const {
  return amplitude_ > 0.0 ? amplitude_ * amplitude_ * matern(std::abs(dt_s) / length_s_) : 0.0;
}

LampDrift::Fit LampDrift::fit(const Hyper& hyper) const {
  const auto n = static_cast<Eigen::Index>(value_.size());
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto a = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double r = std::abs(time_s_[a] - time_s_[static_cast<std::size_t>(j)]) / hyper.length_s;
      covariance(i, j) = covariance(j, i) =
          hyper.amplitude > 0.0 ? hyper.amplitude * hyper.amplitude * matern(r) : 0.0;
    }
    covariance(i, i) += variance_[a] + hyper.scatter * hyper.scatter;
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(value_.data(), n);
  Fit result;
  result.inverse = llt.solve(Eigen::MatrixXd::Identity(n, n));
  const double information = ones.dot(result.inverse * ones);
  result.mean_variance = 1.0 / information;
  result.mean = ones.dot(result.inverse * values) / information;
  const Eigen::VectorXd residual = values - Eigen::VectorXd::Constant(n, result.mean);
  result.weights = result.inverse * residual;
  const double log_determinant = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  result.log_likelihood = -0.5 * (residual.dot(result.weights) + log_determinant + std::log(information));
  return result;
}

// A coarse grid, then coordinate steps in log space that shrink.
LampDrift::Hyper LampDrift::likeliest(bool with_process) const {
  Hyper best;
  double best_value = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const Hyper& hyper) {
    const double value = fit(hyper).log_likelihood;
    if (!(value > best_value)) return false;
    best_value = value;
    best = hyper;
    return true;
  };
  for (const double scatter : {0.0, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2}) {
    if (!with_process) consider({0.0, 1.0, scatter});
    for (const double part : {0.1, 0.3, 1.0, 3.0}) {
      for (const double amplitude : {1e-3, 5e-3, 2e-2, 1e-1}) {
        if (with_process) consider({amplitude, part * span_s_, scatter});
      }
    }
  }
  constexpr double kShortest = 0.05, kLongest = 10.0;  // of the session: shorter is scatter, longer is a straight line
  for (double factor = 2.0; factor > 1.05; factor = std::sqrt(factor)) {
    const std::array<double, 2> steps{factor, 1.0 / factor};
    for (const double step : steps) {
      while (best.scatter > 1e-6 && best.scatter < 0.3 && consider({best.amplitude, best.length_s, best.scatter * step})) {
      }
      if (!with_process) continue;
      while (best.amplitude > 1e-5 && best.amplitude < 1.0 &&
             consider({best.amplitude * step, best.length_s, best.scatter})) {
      }
      while (best.length_s * step > kShortest * span_s_ && best.length_s * step < kLongest * span_s_ &&
             consider({best.amplitude, best.length_s * step, best.scatter})) {
      }
    }
  }
  return best;
}

void LampDrift::choose() {
  Hyper chosen = likeliest(false);
  gain_ = 0.0;
  if (value_.size() >= kLeastSamples) {
    const Hyper moving = likeliest(true);
    gain_ = fit(moving).log_likelihood - fit(chosen).log_likelihood;
    if (gain_ > kLeastGain) chosen = moving;
  }
  const Fit result = fit(chosen);
  amplitude_ = chosen.amplitude;
  length_s_ = chosen.length_s;
  scatter_ = chosen.scatter;
  mean_ = result.mean;
  mean_variance_ = result.mean_variance;
  inverse_ = result.inverse;
  weights_ = result.weights;
}

// Leaves out the sample that the others predict worst, if by more than kOutlierSigmas.
bool LampDrift::drop_worst() {
  if (value_.size() <= kLeastSamples) return false;
  double worst = kOutlierSigmas;
  std::size_t at = value_.size();
  for (std::size_t i = 0; i < value_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    // Left out, the others predict the value with residual weight / inverse and variance 1 / inverse. The scatter must
    // not be what the outlier itself has made of it.
    const double residual = weights_[k] / inverse_(k, k);
    std::vector<double> others;
    for (std::size_t j = 0; j < value_.size(); ++j) {
      const auto m = static_cast<Eigen::Index>(j);
      if (j != i) others.push_back(std::abs(weights_[m] / inverse_(m, m)));
    }
    const double sigma = std::max(1.4826 * median(std::move(others)), std::sqrt(variance_[i]));
    const double off = std::abs(residual) / sigma;
    if (off <= worst) continue;
    worst = off;
    at = i;
  }
  if (at == value_.size()) return false;
  used_[index_[at]] = false;
  const auto gone = static_cast<std::ptrdiff_t>(at);
  index_.erase(index_.begin() + gone);
  time_s_.erase(time_s_.begin() + gone);
  value_.erase(value_.begin() + gone);
  variance_.erase(variance_.begin() + gone);
  return true;
}

Eigen::VectorXd LampDrift::kernel_column(double time_s) const {
  Eigen::VectorXd column(static_cast<Eigen::Index>(value_.size()));
  for (Eigen::Index i = 0; i < column.size(); ++i) column[i] = kernel(time_s - time_s_[static_cast<std::size_t>(i)]);
  return column;
}

LampFactor LampDrift::relative(double time_s, double reference_s) const {
  if (!drifts()) return {1.0, 0.0};
  // The mean drops out of the difference except for its part in the weights.
  const Eigen::VectorXd difference = kernel_column(time_s) - kernel_column(reference_s);
  const double log_factor = difference.dot(weights_);
  const double by_mean = difference.dot(inverse_ * Eigen::VectorXd::Ones(difference.size()));
  const double prior = 2.0 * (kernel(0.0) - kernel(time_s - reference_s));
  const double variance =
      prior - difference.dot(inverse_ * difference) + by_mean * by_mean * mean_variance_;
  const double factor = std::exp(log_factor);
  return {factor, factor * std::sqrt(std::max(0.0, variance))};
}

LampFactor LampDrift::intensity(double time_s) const {
  if (value_.empty()) return {0.0, std::numeric_limits<double>::infinity()};
  const Eigen::VectorXd column = kernel_column(time_s);
  const double by_mean = 1.0 - column.dot(inverse_ * Eigen::VectorXd::Ones(column.size()));
  const double variance = kernel(0.0) - column.dot(inverse_ * column) + by_mean * by_mean * mean_variance_;
  const double value = std::exp(mean_ + column.dot(weights_));
  return {value, value * std::sqrt(std::max(0.0, variance))};
}

}  // namespace lumitexel
