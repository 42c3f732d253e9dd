#include "processing/brdf/normal_equations.h"

#include <cmath>

#include "processing/brdf/ordered_sum.h"

namespace lumitexel {
namespace {

constexpr int kMaxLobes = 3;
constexpr int kMaxParameters = kMaxChannels * (1 + 3 * kMaxLobes);
using SampleJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxChannels, kMaxParameters>;
using SampleResidual = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxChannels, 1>;

// Prediction of r per channel, and its derivatives, before any weighting.
void predict(const BrdfParameters& layout, const Eigen::VectorXd& at, const LobeGeometry& geometry, SampleResidual& value,
             SampleJacobian& slope) {
  const double cos_i = geometry.cos_i;
  slope.setZero();
  for (int c = 0; c < layout.channels(); ++c) {
    value[c] = cos_i * at[layout.diffuse(c)];
    slope(c, layout.diffuse(c)) = cos_i;
  }
  const LobeFamily& family = layout.family();
  for (int l = 0; l < layout.lobes(); ++l) {
    LobeSlopes terms;
    for (int c = 0; c < layout.channels(); ++c) {
      const int shape = layout.log_shape(l, c), aim = layout.aim(l, c);
      if (c == 0 || !layout.shared_shape()) terms = family.slopes(at[shape], family.aims ? at[aim] : kMirrorAim, geometry);
      const double strength = cos_i * std::exp(at[layout.log_strength(l, c)]);
      value[c] += strength * terms.gain + cos_i * terms.offset;
      slope(c, layout.log_strength(l, c)) = strength * terms.gain;
      slope(c, shape) = strength * terms.gain_by_shape + cos_i * terms.offset_by_shape;
      if (family.aims) slope(c, aim) = strength * terms.gain_by_aim;
    }
  }
}

}  // namespace

BrdfProblem::BrdfProblem(FitSamples samples, const BrdfParameters& layout, const ErrorModel& error)
    : samples_(samples), layout_(layout), error_(error), weights_(samples.size()) {}

void BrdfProblem::reweight(const Eigen::VectorXd& at) {
  const Brdf model = layout_.brdf(at);
  for_each_block(samples_.size(), [&](std::size_t s) {
    const Observation& sample = *samples_[s].observation;
    const ChannelValues predicted = predicted_reflectance(model, sample.geometry);
    const SampleMisfit misfit = sample_misfit(error_, sample, layout_.channels(), predicted);
    for (std::size_t c = 0; c < static_cast<std::size_t>(layout_.channels()); ++c) {
      weights_[s].inverse_scale[c] = 1.0 / std::sqrt(error_.variance(predicted[c], static_cast<double>(sample.variance[c])));
    }
    weights_[s].root = std::sqrt(samples_[s].share * robust_weight(error_, misfit, layout_.channels()));
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
    SampleResidual residual(channels);
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
  SampleResidual residual(layout_.channels());
  SampleJacobian slope(layout_.channels(), layout_.size());
  predict(layout_, at, sample.geometry, residual, slope);
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

NormalEquations& operator+=(NormalEquations& a, const NormalEquations& b) {
  a.matrix += b.matrix;
  a.gradient += b.gradient;
  a.cost += b.cost;
  return a;
}

}  // namespace lumitexel
