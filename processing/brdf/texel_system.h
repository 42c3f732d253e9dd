// The small least-squares problem of one texel: its samples against the basis BRDFs that it may mix, and the prior on the weights.
#pragma once

#include <span>
#include <vector>

#include "processing/brdf/basis_values.h"
#include "processing/brdf/brdf_slopes.h"
#include "processing/brdf/error_model.h"
#include "processing/brdf/nnls.h"
#include "processing/brdf/texel_prior.h"

namespace lumitexel {

using SamplePredictions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxChannels, kMaxBasis>;  // channels x bases

struct SampleEquations {  // of one sample, a row a channel: as measured, and whitened by the error model at the material's prediction
  SamplePredictions predicted, whitened;
  SampleValues measured, target;
};

struct TexelSystem {
  std::vector<SampleEquations> samples;
  BasisMatrix matrix;
  BasisVector right;
};

// Weighted by the error model at the prediction of the material. At most kMaxBasis bases.
TexelSystem texel_system(std::span<const Observation> samples, int channels, const BasisValues& basis, const ErrorModel& error);

// Precision of the prior on the weights; its mean is (1, 0, 0, …), the material itself. Relative deviations are those of basis[0].
class PriorPrecision {
 public:
  PriorPrecision(const std::vector<Brdf>& basis, int channels);
  void add_to(const TexelPrior& prior, BasisMatrix& matrix, BasisVector& right) const;
  // Of the prior alone at the given weights: (w - mean)^T precision (w - mean).
  double cost(const TexelPrior& prior, const BasisVector& weights) const;

 private:
  BasisMatrix precision(const TexelPrior& prior) const;  // empty for a prior that says nothing

  BasisMatrix diffuse_, gloss_;
};

}  // namespace lumitexel
