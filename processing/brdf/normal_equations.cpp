#include "processing/brdf/normal_equations.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "processing/brdf/brdf_slopes.h"
#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
BrdfProblem::BrdfProblem(FitSamples samples, const BrdfParameters& layout, const ErrorModel& error, bool robust)
    : samples_(samples), layout_(layout), error_(error), robust_(robust), weights_(samples.size()) {}

void BrdfProblem::reweight(const Eigen::VectorXd& at) {
  const Brdf model = layout_.brdf(at);
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
  const Brdf model = layout_.brdf(at);
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
    if (whitening.size() > 0) residual = (whitening.triangularView<Eigen::Lower>() * residual).eval();
    sum += residual.squaredNorm();
  });
}

void BrdfProblem::add(const Eigen::VectorXd& at, std::size_t s, NormalEquations& sums) const {
  const Observation& sample = *samples_[s].observation;
  SampleValues residual(layout_.channels());
  SampleSlopes slope(layout_.channels(), layout_.size());
  predict_with_slopes(layout_, at, sample.geometry, residual, slope);
  for (int c = 0; c < layout_.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const double scale = weights_[s].root * weights_[s].inverse_scale[channel];
    residual[c] = scale * (residual[c] - static_cast<double>(sample.reflectance[channel]));
    slope.row(c) *= scale;
  }
  if (error_.whitening().size() > 0) {
    residual = (error_.whitening().triangularView<Eigen::Lower>() * residual).eval();
    slope = (error_.whitening().triangularView<Eigen::Lower>() * slope).eval();
  }
  sums.cost += residual.squaredNorm();
  sums.gradient.noalias() += slope.transpose() * residual;
  for (int c = 0; c < layout_.channels(); ++c) {
    sums.matrix.selfadjointView<Eigen::Lower>().rankUpdate(slope.row(c).transpose());
  }
}

NormalEquations BrdfProblem::linearise(const Eigen::VectorXd& at) const {
  const int n = layout_.size();
  NormalEquations sums = ordered_sum(
      samples_.size(), NormalEquations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0},
      [&](std::size_t s, NormalEquations& block) { add(at, s, block); });
  sums.matrix = sums.matrix.selfadjointView<Eigen::Lower>();
  return sums;
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
