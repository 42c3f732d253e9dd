#include "processing/brdf/normal_equations.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {
namespace {

// L v and L S in place, L lower triangular: from the last row, which needs all, to the first.
void whiten(const ChannelMatrix& lower, SampleValues& value, SampleSlopes& slope) {
  const Eigen::Index n = slope.cols();
  for (Eigen::Index i = lower.rows(); i-- > 0;) {
    double* row = slope.data() + i * n;
    value[i] *= lower(i, i);
    for (Eigen::Index p = 0; p < n; ++p) row[p] *= lower(i, i);
    for (Eigen::Index j = 0; j < i; ++j) {
      const double* other = slope.data() + j * n;
      value[i] += lower(i, j) * value[j];
      for (Eigen::Index p = 0; p < n; ++p) row[p] += lower(i, j) * other[p];
    }
  }
}

double squared_norm(const ChannelMatrix& lower, const SampleValues& value) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    double whitened = lower.size() > 0 ? 0.0 : value[i];
    for (Eigen::Index j = 0; lower.size() > 0 && j <= i; ++j) whitened += lower(i, j) * value[j];
    sum += whitened * whitened;
  }
  return sum;
}

}  // namespace

BrdfProblem::BrdfProblem(FitSamples samples, const BrdfParameters& layout, const ErrorModel& error, bool robust)
    : samples_(samples), layout_(layout), error_(error), robust_(robust), weights_(samples.size()) {}

void BrdfProblem::reweight(const Eigen::VectorXd& at) {
  const PreparedBrdf model(layout_.brdf(at));
  for_each_block(samples_.size(), [&](std::size_t s) {
    const Observation& sample = *samples_[s].observation;
    const ChannelValues predicted = predicted_reflectance(model, sample.geometry);
    const SampleMisfit misfit = sample_misfit(error_, sample, layout_.channels(), predicted);
    for (std::size_t c = 0; c < static_cast<std::size_t>(layout_.channels()); ++c) {
      weights_[s].inverse_scale[c] = 1.0 / std::sqrt(error_.variance(predicted[c], static_cast<double>(sample.variance[c])));
    }
    weights_[s].root = std::sqrt(samples_[s].share * (robust_ ? robust_weight(error_, misfit, layout_.channels()) : 1.0));
  });
}

double BrdfProblem::total_weight() const {
  double sum = 0.0;
  for (const SampleWeight& weight : weights_) sum += weight.root * weight.root;
  return sum;
}

double BrdfProblem::cost(const Eigen::VectorXd& at) const {
  const PreparedBrdf model(layout_.brdf(at));
  const ChannelMatrix& whitening = error_.whitening();
  const int channels = layout_.channels();
  return ordered_sum(samples_.size(), 0.0, [&](std::size_t s, double& sum) {
    const Observation& sample = *samples_[s].observation;
    const ChannelValues predicted = predicted_reflectance(model, sample.geometry);
    SampleValues residual(channels);
    for (int c = 0; c < channels; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      residual[c] = weights_[s].root * weights_[s].inverse_scale[channel] *
                    (predicted[channel] - static_cast<double>(sample.reflectance[channel]));
    }
    sum += squared_norm(whitening, residual);
  });
}

// Plain loops: the library's product of matrices this small, and of a size unknown to the compiler, takes several times as long.
void BrdfProblem::add(const BrdfSlopes& model, std::size_t s, NormalEquations& sums) const {
  const Observation& sample = *samples_[s].observation;
  SampleValues residual;
  SampleSlopes slope;
  model.predict(sample.geometry, residual, slope);
  for (int c = 0; c < layout_.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const double scale = weights_[s].root * weights_[s].inverse_scale[channel];
    residual[c] = scale * (residual[c] - static_cast<double>(sample.reflectance[channel]));
    slope.row(c) *= scale;
  }
  if (error_.whitening().size() > 0) whiten(error_.whitening(), residual, slope);
  const int n = layout_.size();
  for (int c = 0; c < layout_.channels(); ++c) {
    const double* row = slope.data() + c * n;
    sums.cost += residual[c] * residual[c];
    for (int j = 0; j < n; ++j) {
      if (row[j] == 0.0) continue;  // most: a channel knows its own strengths only
      double* column = sums.matrix.data() + j * n;
      sums.gradient[j] += row[j] * residual[c];
      for (int i = j; i < n; ++i) column[i] += row[i] * row[j];
    }
  }
}

NormalEquations BrdfProblem::linearise(const Eigen::VectorXd& at) const {
  const int n = layout_.size();
  const BrdfSlopes model(layout_, at);
  NormalEquations sums = ordered_sum(
      samples_.size(), NormalEquations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0},
      [&](std::size_t s, NormalEquations& block) { add(model, s, block); });
  sums.matrix = sums.matrix.selfadjointView<Eigen::Lower>();
  return sums;
}

Eigen::MatrixXd BrdfProblem::scatter_by_lumitexel(const Eigen::VectorXd& at) const {
  const int n = layout_.size();
  const BrdfSlopes model(layout_, at);
  NormalEquations own{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0};
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    add(model, s, own);
    if (s + 1 < samples_.size() && samples_[s + 1].lumitexel == samples_[s].lumitexel) continue;
    scatter += own.gradient * own.gradient.transpose();
    own.gradient.setZero();
  }
  return scatter;
}

double BrdfProblem::robust_slope(const Eigen::VectorXd& at) const {
  if (!robust_) return 1.0;
  constexpr double kStep = 1e-4;  // of the residual: rounding and curvature are both below 1e-7 then
  const PreparedBrdf model(layout_.brdf(at));
  double weights = 0.0, slopes = 0.0;
  for (const FitSample& sample : samples_) {
    const SampleMisfit misfit = sample_misfit(error_, *sample.observation, layout_.channels(), predicted_reflectance(model, sample.observation->geometry));
    const auto weight = [&](double stretch) {
      return sample.share * robust_weight(error_, {misfit.squares * stretch * stretch, misfit.variances}, layout_.channels());
    };
    weights += weight(1.0);
    // Along the residual, one of as many directions as there are channels, the weight changes as well.
    slopes += weight(1.0) + (weight(1.0 + kStep) - weight(1.0 - kStep)) / (2.0 * kStep) / layout_.channels();
  }
  return weights > 0.0 ? slopes / weights : 1.0;
}

Eigen::VectorXd damped_step(const NormalEquations& equations, const std::vector<bool>& held, double damping) {
  Eigen::MatrixXd matrix = equations.matrix;
  Eigen::VectorXd right = -equations.gradient;
  for (int i = 0; i < matrix.rows(); ++i) {
    // Each by its own curvature: a share of the largest would freeze the lobe of a nearly black material.
    matrix(i, i) += damping * matrix(i, i);
    if (!held[static_cast<std::size_t>(i)] && matrix(i, i) > 0.0) continue;
    matrix.row(i).setZero();
    matrix.col(i).setZero();
    matrix(i, i) = 1.0;
    right[i] = 0.0;
  }
  return matrix.ldlt().solve(right);
}

NormalEquations& operator+=(NormalEquations& a, const NormalEquations& b) {
  a.matrix += b.matrix;
  a.gradient += b.gradient;
  a.cost += b.cost;
  return a;
}

}  // namespace lumitexel
