#include "processing/brdf/estimate_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFewestSamples = 30;
constexpr int kRounds = 4, kRoundsMore = 2;  // from where the start was, and after each change of the tails
constexpr std::size_t kSamplesForTails = 6000;  // which kind of tails, so many say
constexpr int kOutlierRounds = 12;  // the two normal distributions' shares settle slowly
constexpr double kFirstShare = 0.02, kFirstScale = 8.0;  // where they begin
constexpr double kLeastShare = 1e-5, kMostShare = 0.25, kLeastScale = 2.0, kMostScale = 1e3;
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
  const PreparedBrdf prepared(brdf);
  for_each_block(samples.size(), [&](std::size_t s) {
    residuals.predicted[s] = predicted_reflectance(prepared, samples[s].observation->geometry);
  });
  return residuals;
}

// Of some thousand samples.
double median_reflectance(const Residuals& residuals) {
  std::vector<double> values;
  const std::size_t stride = residuals.samples.size() / 2000 + 1;
  for (std::size_t s = 0; s < residuals.samples.size(); s += stride) {
    const FitSample& sample = residuals.samples[s];
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
  double outliers = 0, outlier_squares = 0;  // of the wider normal distribution: samples, and their squared whitened residuals
  Moments& operator+=(const Moments& other) {
    matrix += other.matrix;
    right += other.right;
    products += other.products;
    weight += other.weight;
    outliers += other.outliers;
    outlier_squares += other.outlier_squares;
    return *this;
  }
};

Moments moments(const Residuals& residuals, const ErrorModel& error) {
  Moments all = ordered_sum(residuals.samples.size(), Moments{}, [&](std::size_t s, Moments& sums) {
    const Observation& sample = *residuals.samples[s].observation;
    const ScaledResiduals scaled = scaled_residuals(error, sample, residuals.channels, residuals.predicted[s]);
    const SampleMisfit misfit = sample_misfit(error, scaled, residuals.channels);
    const double share = residuals.samples[s].share, inlier = inlier_probability(error, misfit, residuals.channels);
    const double tail = error.outlier_share > 0.0 ? weight_of_inlier(error, inlier) : robust_weight(error, misfit, residuals.channels);
    sums.outliers += share * (1.0 - inlier);
    sums.outlier_squares += share * (1.0 - inlier) * misfit.squares;
    for (int c = 0; c < residuals.channels; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const double square = residuals.predicted[s][channel] * residuals.predicted[s][channel], r = residuals.residual(s, channel);
      const double variance = scaled.scale[channel] * scaled.scale[channel], w = share / (variance * variance);
      const double excess = w * (tail * r * r - residuals.noise(s, channel));
      sums.matrix(0, 0) += w * square * square;
      sums.matrix(0, 1) += w * square;
      sums.matrix(1, 1) += w;
      sums.right[0] += excess * square;
      sums.right[1] += excess;
      for (int d = 0; d <= c; ++d) sums.products(c, d) += share * tail * scaled.over_scale[channel] * scaled.over_scale[static_cast<std::size_t>(d)];
    }
    sums.weight += share;
  });
  all.matrix(1, 0) = all.matrix(0, 1);
  all.products = all.products.selfadjointView<Eigen::Lower>();
  return all;
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

void refine_outliers(const Moments& sums, int channels, ErrorModel& error) {
  if (error.outlier_share <= 0.0 || sums.weight <= 0.0) return;
  error.outlier_share = std::clamp(sums.outliers / sums.weight, kLeastShare, kMostShare);
  if (sums.outliers <= 0.0) return;
  error.outlier_scale = std::clamp(std::sqrt(sums.outlier_squares / (sums.outliers * channels)), kLeastScale, kMostScale);
}

void refine(const Residuals& residuals, double least_floor, int rounds, ErrorModel& error) {
  for (int round = 0; round < rounds; ++round) {
    const Moments sums = moments(residuals, error);
    const Eigen::Vector2d scales = two_scales(sums);
    if (!scales.allFinite()) return;
    error.relative = std::clamp(std::sqrt(scales[0]), kLeastRelative, kMostRelative);
    error.floor = std::max(least_floor, std::sqrt(scales[1]));
    error.set_correlation(correlation_of(sums, residuals.channels));
    refine_outliers(sums, residuals.channels, error);
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

struct Estimate {
  ErrorModel error;
  double deviance = 0;
};

// From the tails of the start towards heavier or lighter ones, for as long as the likelihood rises.
Estimate with_students_tails(const Residuals& residuals, double floor, const ErrorModel& start) {
  const auto with_freedom = [&](std::size_t i, const ErrorModel& from, int rounds) {
    Estimate estimate{from};
    estimate.error.freedom = kFreedoms[i];
    estimate.error.outlier_share = 0.0;
    refine(residuals, floor, rounds, estimate.error);
    estimate.deviance = total_deviance(residuals, estimate.error);
    return estimate;
  };
  const std::size_t at = nearest_freedom(start.freedom);
  Estimate best = with_freedom(at, start, kRounds);
  for (const int step : {1, -1}) {
    for (std::size_t next = at + static_cast<std::size_t>(step); next < std::size(kFreedoms); next += static_cast<std::size_t>(step)) {
      const Estimate trial = with_freedom(next, best.error, kRoundsMore);
      if (!(trial.deviance < best.deviance)) break;
      best = trial;
    }
  }
  return best;
}

Estimate with_outliers(const Residuals& residuals, double floor, const ErrorModel& start) {
  Estimate estimate{start};
  if (start.outlier_share <= 0.0) {
    estimate.error.freedom = ErrorModel::kGaussian;
    estimate.error.outlier_share = kFirstShare;
    estimate.error.outlier_scale = kFirstScale;
  }
  refine(residuals, floor, kOutlierRounds, estimate.error);
  estimate.deviance = total_deviance(residuals, estimate.error);
  return estimate;
}

ErrorModel with_likeliest_tails(const Residuals& residuals, const ErrorModel& start) {
  const double floor = least_floor(residuals);
  const Estimate students = with_students_tails(residuals, floor, start);
  if (students.error.freedom >= ErrorModel::kGaussian) return students.error;  // no tails at all
  const Estimate outliers = with_outliers(residuals, floor, start.outlier_share > 0.0 ? start : students.error);
  // One number more than Student's tails have, paid for as in fit_material.h.
  double count = 0.0;
  for (const FitSample& sample : residuals.samples) count += sample.share;
  const double independence = independence_of(residuals, outliers.error), price = std::log(std::max(2.0, count * independence));
  return independence * (students.deviance - outliers.deviance) > price ? outliers.error : students.error;
}

// Every so manieth, about `most` samples; the list ends with whole lumitexels.
std::vector<FitSample> whole_lumitexels(FitSamples samples, std::size_t most) {
  const std::size_t stride = samples.size() / most + 1;
  std::vector<FitSample> some;
  std::size_t lumitexels = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    if (s > 0 && samples[s].lumitexel != samples[s - 1].lumitexel) ++lumitexels;
    if (lumitexels % stride == 0) some.push_back(samples[s]);
  }
  return some;
}

}  // namespace

ErrorModel estimate_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& start) {
  if (samples.size() < kFewestSamples) return start;
  const std::vector<FitSample> some = whole_lumitexels(samples, kSamplesForTails);
  ErrorModel best = with_likeliest_tails(residuals_of(brdf, some), start);
  const Residuals residuals = residuals_of(brdf, samples);
  if (some.size() < samples.size()) refine(residuals, least_floor(residuals), kRoundsMore, best);
  best.independence = independence_of(residuals, best);
  return best;
}

double independence_of(const Brdf& brdf, FitSamples samples, const ErrorModel& error) {
  return independence_of(residuals_of(brdf, samples), error);
}

ErrorModel updated_error_model(const Brdf& brdf, FitSamples samples, const ErrorModel& error) {
  if (samples.size() < kFewestSamples) return error;
  const Residuals residuals = residuals_of(brdf, samples);
  ErrorModel updated = error;
  refine(residuals, least_floor(residuals), 1, updated);
  return updated;
}

}  // namespace lumitexel
