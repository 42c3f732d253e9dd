#include "processing/brdf/estimate_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFewestSamples = 30;
constexpr int kRounds = 4;
constexpr double kFreedoms[] = {2.5, 3.0, 4.0, 6.0, 10.0, 30.0, ErrorModel::kGaussian};
constexpr double kLeastRelative = 1e-4, kMostRelative = 1.0;
constexpr double kLeastFloorShare = 1e-4;  // of the median reflectance
constexpr double kLeastEigenvalue = 0.01;  // of the channels' correlation, so that no colour difference counts without bound

struct Residuals {
  int channels = 0;
  std::vector<ChannelValues> predicted;
  FitSamples samples;

  double residual(std::size_t s, std::size_t c) const {
    return static_cast<double>(samples[s].observation->reflectance[c]) - predicted[s][c];
  }
  double noise(std::size_t s, std::size_t c) const { return static_cast<double>(samples[s].observation->variance[c]); }
};

Residuals residuals_of(const Brdf& brdf, FitSamples samples) {
  Residuals residuals{brdf.channels, std::vector<ChannelValues>(samples.size()), samples};
  for_each_block(samples.size(), [&](std::size_t s) {
    residuals.predicted[s] = predicted_reflectance(brdf, samples[s].observation->geometry);
  });
  return residuals;
}

double median_reflectance(const Residuals& residuals) {
  std::vector<double> values;
  for (const FitSample& sample : residuals.samples) {
    for (int c = 0; c < residuals.channels; ++c) {
      values.push_back(std::abs(static_cast<double>(sample.observation->reflectance[static_cast<std::size_t>(c)])));
    }
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double total_deviance(const Residuals& residuals, const ErrorModel& error) {
  const double constant = deviance_constant(error, residuals.channels);
  return ordered_sum(residuals.samples.size(), 0.0, [&](std::size_t s, double& sum) {
    const auto misfit = sample_misfit(error, *residuals.samples[s].observation, residuals.channels, residuals.predicted[s]);
    sum += residuals.samples[s].share * (deviance(error, misfit, residuals.channels) + constant);
  });
}

struct Moments {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();   // of the regression of squared residuals on (predicted^2, 1)
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  ChannelMatrix products = ChannelMatrix::Zero(kMaxChannels, kMaxChannels);  // of scaled residuals
  double weight = 0;
  Moments& operator+=(const Moments& other) {
    matrix += other.matrix;
    right += other.right;
    products += other.products;
    weight += other.weight;
    return *this;
  }
};

Moments moments(const Residuals& residuals, const ErrorModel& error) {
  return ordered_sum(residuals.samples.size(), Moments{}, [&](std::size_t s, Moments& sums) {
    const Observation& sample = *residuals.samples[s].observation;
    const double tail = robust_weight(error, sample_misfit(error, sample, residuals.channels, residuals.predicted[s]), residuals.channels);
    const double share = residuals.samples[s].share;
    Eigen::Matrix<double, kMaxChannels, 1> scaled = Eigen::Matrix<double, kMaxChannels, 1>::Zero();
    for (int c = 0; c < residuals.channels; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const double predicted = residuals.predicted[s][channel], r = residuals.residual(s, channel);
      const double variance = error.variance(predicted, residuals.noise(s, channel));
      const Eigen::Vector2d by(predicted * predicted, 1.0);
      sums.matrix += share / (variance * variance) * by * by.transpose();
      sums.right += share / (variance * variance) * (tail * r * r - residuals.noise(s, channel)) * by;
      scaled[c] = r / std::sqrt(variance);
    }
    sums.products += share * tail * scaled * scaled.transpose();
    sums.weight += share;
  });
}

// Both coefficients non-negative; where the two cannot be told apart the relative one takes it all.
Eigen::Vector2d two_scales(const Moments& sums) {
  const Eigen::Vector2d unit(1.0 / std::sqrt(std::max(1e-300, sums.matrix(0, 0))), 1.0 / std::sqrt(std::max(1e-300, sums.matrix(1, 1))));
  const Eigen::Matrix2d scaled = unit.asDiagonal() * sums.matrix * unit.asDiagonal();
  const Eigen::Vector2d right = unit.asDiagonal() * sums.right;
  constexpr double kTooAlike = 1e-8;
  Eigen::Vector2d solution(std::max(0.0, right[0]), 0.0);
  if (scaled.determinant() > kTooAlike) {
    const Eigen::Vector2d free = scaled.inverse() * right;
    if (free.minCoeff() >= 0.0) solution = free;
    else if (free[0] < 0.0) solution = {0.0, std::max(0.0, right[1])};
  }
  return unit.asDiagonal() * solution;
}

ChannelMatrix correlation_of(const Moments& sums, int channels) {
  const ChannelMatrix products = sums.products.topLeftCorner(channels, channels);
  const ChannelMatrix scale = products.diagonal().array().max(1e-300).rsqrt().matrix().asDiagonal();
  ChannelMatrix correlation = scale * products * scale;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(correlation)};
  if (!(eigen.eigenvalues().minCoeff() >= kLeastEigenvalue)) {
    correlation = (1.0 - kLeastEigenvalue) * correlation + kLeastEigenvalue * ChannelMatrix::Identity(channels, channels);
  }
  return correlation.allFinite() ? correlation : ChannelMatrix::Identity(channels, channels);
}

double least_floor(const Residuals& residuals) { return std::max(1e-12, kLeastFloorShare * median_reflectance(residuals)); }

void refine(const Residuals& residuals, double least_floor, int rounds, ErrorModel& error) {
  for (int round = 0; round < rounds; ++round) {
    const Moments sums = moments(residuals, error);
    const Eigen::Vector2d scales = two_scales(sums);
    if (!scales.allFinite()) return;
    error.relative = std::clamp(std::sqrt(scales[0]), kLeastRelative, kMostRelative);
    error.floor = std::max(least_floor, std::sqrt(scales[1]));
    error.set_correlation(correlation_of(sums, residuals.channels));
  }
}

// 1 over the design effect 1 + (m - 1) rho, rho the correlation of two whitened residuals of one lumitexel, outliers tamed by
// their robust weights.
double independence_of(const Residuals& residuals, const ErrorModel& error) {
  double pairs = 0.0, pair_products = 0.0, squares = 0.0, count = 0.0;
  const auto channels = static_cast<std::size_t>(residuals.channels);
  for (std::size_t begin = 0; begin < residuals.samples.size();) {
    std::size_t end = begin;
    ChannelValues sum{};
    double own_squares = 0.0;
    for (; end < residuals.samples.size() && residuals.samples[end].lumitexel == residuals.samples[begin].lumitexel; ++end) {
      const Observation& sample = *residuals.samples[end].observation;
      const double root = std::sqrt(robust_weight(
          error, sample_misfit(error, sample, residuals.channels, residuals.predicted[end]), residuals.channels));
      for (std::size_t c = 0; c < channels; ++c) {
        const double z = root * residuals.residual(end, c) / std::sqrt(error.variance(residuals.predicted[end][c], residuals.noise(end, c)));
        sum[c] += z;
        own_squares += z * z;
      }
    }
    const double share = residuals.samples[begin].share, m = static_cast<double>(end - begin);
    double product = -own_squares;
    for (std::size_t c = 0; c < channels; ++c) product += sum[c] * sum[c];
    pair_products += share * product;
    pairs += share * m * (m - 1.0);
    squares += share * own_squares;
    count += share * m;
    begin = end;
  }
  if (pairs <= 0.0 || squares <= 0.0) return 1.0;
  const double correlation = std::clamp(pair_products / pairs / (squares / count), 0.0, 1.0);
  return 1.0 / (1.0 + pairs / count * correlation);
}

std::size_t nearest_freedom(double freedom) {
  std::size_t i = 0;
  while (i + 1 < std::size(kFreedoms) && kFreedoms[i] < freedom) ++i;
  return i;
}

}  // namespace

ErrorModel estimate_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& start) {
  if (samples.size() < kFewestSamples) return start;
  const Residuals residuals = residuals_of(brdf, samples);
  const double floor = least_floor(residuals);
  // From the tails of the start towards heavier or lighter ones, for as long as the likelihood rises.
  const auto with_freedom = [&](std::size_t i, const ErrorModel& from) {
    ErrorModel error = from;
    error.freedom = kFreedoms[i];
    refine(residuals, floor, kRounds, error);
    return error;
  };
  std::size_t at = nearest_freedom(start.freedom);
  ErrorModel best = with_freedom(at, start);
  double best_deviance = total_deviance(residuals, best);
  for (const int step : {1, -1}) {
    for (std::size_t next = at + static_cast<std::size_t>(step); next < std::size(kFreedoms); next += static_cast<std::size_t>(step)) {
      const ErrorModel trial = with_freedom(next, best);
      const double deviance = total_deviance(residuals, trial);
      if (!(deviance < best_deviance)) break;
      best = trial;
      best_deviance = deviance;
      at = next;
    }
  }
  best.independence = independence_of(residuals, best);
  return best;
}

ErrorModel updated_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& error) {
  if (samples.size() < kFewestSamples) return error;
  const Residuals residuals = residuals_of(brdf, samples);
  ErrorModel updated = error;
  refine(residuals, least_floor(residuals), 1, updated);
  return updated;
}

}  // namespace lumitexel
