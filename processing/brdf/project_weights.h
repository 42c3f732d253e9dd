// Every texel its own mixture of its material's basis (section 8 of the paper, eq. 12): non-negative least squares over
// all samples and channels, with a Gaussian prior around the material itself.
//
// With a handful of samples and more bases than that, plain least squares predicts unseen photographs worse than the
// material alone does. The prior says how far texels of one material differ in what one sees: in the diffuse reflectance (light and
// view at 45 degrees on the same side) and in the gloss (mirror reflection at 30 degrees). Its two widths are not chosen by
// hand but by leaving out one sample after the other and predicting it: where texels do not differ, both are zero
// and projection returns the material.
#pragma once

#include <span>
#include <vector>

#include "processing/brdf/basis_values.h"
#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"
#include "processing/brdf/texel_prior.h"
#include "processing/brdf/texel_system.h"

namespace lumitexel {

struct TexelWeights {
  std::vector<float> weight;     // of each basis, >= 0
  float relative_sigma = 0;      // one-sigma of the predicted reflectance, relative: from the posterior, in which samples count
                                 // as often as they err independently; the error model's own where nothing may vary
};

// What all texels of a material share. basis[0] is the material itself, or what principal function analysis made of it; samples are
// weighted by the error model at the prediction of `material`, so that what is moved does not change the measure.
struct TexelBasis {
  TexelBasis(const std::vector<Brdf>& basis, const Brdf& material, const ErrorModel& error_model, Precision precision = Precision::Double)
      : channels(material.channels), values(basis, material, precision), prior(basis, material.channels), error(error_model) {}
  TexelBasis(const std::vector<Brdf>& basis, const ErrorModel& error_model) : TexelBasis(basis, basis[0], error_model) {}

  int channels;
  BasisValues values;
  PriorPrecision prior;
  ErrorModel error;
};

// Weights of one texel.
TexelWeights project_texel(std::span<const Observation> samples, const TexelBasis& basis, const TexelPrior& prior);

struct PriorChoice {
  TexelPrior prior;
  double left_out_error = 0;          // misfit of left-out samples, mean a sample and channel, with that prior
  double left_out_error_without = 0;    // the same with the material alone
  std::size_t samples = 0;              // that were left out in turn
  std::vector<double> by_texel;         // misfit of each tried lumitexel's left-out samples, summed: the same lumitexels for any basis
};

// The pair of widths whose left-out samples are predicted best in the error model's sense, among those that do not
// predict them worse than the material alone does in plain squares, which is what a rendering shows.
// members: lumitexels of the material; at most some thousand of them are tried.
PriorChoice choose_prior(const Observations& observations, const std::vector<std::size_t>& members, const TexelBasis& basis);

}  // namespace lumitexel
