#include "processing/brdf/texel_system.h"

#include <cmath>

#include "processing/brdf/highlight.h"

namespace lumitexel {
namespace {

// A weak pull on every weight, so that bases that look alike share what neither data nor prior tell apart.
constexpr double kWeightWidth = 2.0;
// Relative to at least this reflectance (1/sr): a metal has no diffuse light to vary by a fraction of.
constexpr double kFaintest = 0.01;
constexpr LobeGeometry kDiffuseGeometry = geometry_of_cosines(1.0, 0.7071067811865476, 0.7071067811865476);  // wi = wo, 45 degrees

// Mean over channels of b b^T, b the bases' reflectances relative to the material's at one geometry.
BasisMatrix gram(const std::vector<Brdf>& basis, int channels, const LobeGeometry& geometry) {
  const auto n = static_cast<Eigen::Index>(basis.size());
  BasisMatrix sum = BasisMatrix::Zero(n, n);
  for (int c = 0; c < channels; ++c) {
    const double own = std::max(kFaintest, evaluate(basis[0], c, geometry));
    BasisVector relative(n);
    for (Eigen::Index k = 0; k < n; ++k) relative[k] = evaluate(basis[static_cast<std::size_t>(k)], c, geometry) / own;
    sum += relative * relative.transpose() / channels;
  }
  return sum;
}

// values: of the bases, then of the material.
SampleEquations equations_of(const Observation& sample, int channels, std::span<const ChannelValues> values, const ErrorModel& error) {
  const std::size_t bases = values.size() - 1;
  const ChannelValues& expected = values[bases];
  SampleEquations equations{SamplePredictions(channels, bases), {}, SampleValues(channels), {}};
  SampleValues inverse_scale(channels);
  for (std::size_t k = 0; k < bases; ++k) {
    for (int c = 0; c < channels; ++c) equations.predicted(c, static_cast<Eigen::Index>(k)) = values[k][static_cast<std::size_t>(c)];
  }
  for (int c = 0; c < channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    equations.measured[c] = static_cast<double>(sample.reflectance[channel]);
    inverse_scale[c] = 1.0 / std::sqrt(error.variance(expected[channel], static_cast<double>(sample.variance[channel])));
  }
  equations.whitened = inverse_scale.asDiagonal() * equations.predicted;
  equations.target = inverse_scale.cwiseProduct(equations.measured);
  if (error.whitening().size() > 0) {
    equations.whitened = (error.whitening() * equations.whitened).eval();
    equations.target = (error.whitening() * equations.target).eval();
  }
  return equations;
}

}  // namespace

TexelSystem texel_system(std::span<const Observation> samples, int channels, const BasisValues& basis, const ErrorModel& error) {
  const auto n = static_cast<Eigen::Index>(basis.bases());
  TexelSystem system{{}, BasisMatrix::Zero(n, n), BasisVector::Zero(n)};
  system.samples.reserve(samples.size());
  std::vector<ChannelValues> values;
  basis.predict(samples, values);
  const std::size_t stride = basis.bases() + 1;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const SampleEquations equations = equations_of(samples[s], channels, std::span(values).subspan(s * stride, stride), error);
    system.matrix += equations.whitened.transpose() * equations.whitened;
    system.right += equations.whitened.transpose() * equations.target;
    system.samples.push_back(equations);
  }
  return system;
}

PriorPrecision::PriorPrecision(const std::vector<Brdf>& basis, int channels)
    : diffuse_(gram(basis, channels, kDiffuseGeometry)), gloss_(gram(basis, channels, kGlossGeometry)) {}

BasisMatrix PriorPrecision::precision(const TexelPrior& prior) const {
  if (std::isinf(prior.diffuse_width) && std::isinf(prior.gloss_width)) return {};
  BasisMatrix precision = diffuse_ / (prior.diffuse_width * prior.diffuse_width) + gloss_ / (prior.gloss_width * prior.gloss_width);
  precision.diagonal().array() += 1.0 / (kWeightWidth * kWeightWidth);
  return precision;
}

void PriorPrecision::add_to(const TexelPrior& prior, BasisMatrix& matrix, BasisVector& right) const {
  const BasisMatrix own = precision(prior);
  if (own.size() == 0) return;
  matrix += own;
  right += own.col(0);
}

double PriorPrecision::cost(const TexelPrior& prior, const BasisVector& weights) const {
  const BasisMatrix own = precision(prior);
  if (own.size() == 0) return 0.0;
  BasisVector deviation = weights;
  deviation[0] -= 1.0;
  return deviation.dot(own * deviation);
}

}  // namespace lumitexel
