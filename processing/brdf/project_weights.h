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

#include "processing/brdf/error_model.h"
#include "processing/brdf/nnls.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// One-sigma of a texel's relative deviation from its material. Both infinite: the paper's plain least squares.
// Either may be zero only with the other: then nothing varies.
struct TexelPrior {
  double diffuse_width = 0.4, gloss_width = 0.1;
};

struct TexelWeights {
  std::vector<float> weight;     // of each basis, >= 0
  float relative_sigma = 0;      // one-sigma of the predicted reflectance, relative: from the posterior, in which samples count
                                 // as often as they err independently; the error model's own where nothing may vary
};

inline bool nothing_varies(const TexelPrior& prior) { return prior.diffuse_width <= 0.0 && prior.gloss_width <= 0.0; }

// Weights of one texel. basis[0] is the material itself, or what principal function analysis made of it; samples are weighted by the
// error model at the prediction of `material`, so that what is moved does not change the measure.
TexelWeights project_texel(std::span<const Observation> samples, int channels, const std::vector<Brdf>& basis, const Brdf& material,
                           const ErrorModel& error, const TexelPrior& prior);
inline TexelWeights project_texel(std::span<const Observation> samples, int channels, const std::vector<Brdf>& basis,
                                  const ErrorModel& error, const TexelPrior& prior) {
  return project_texel(samples, channels, basis, basis[0], error, prior);
}

struct PriorChoice {
  TexelPrior prior;
  double left_out_error = 0;          // misfit of left-out samples, mean a sample and channel, with that prior
  double left_out_error_without = 0;    // the same with the material alone
  std::size_t samples = 0;              // that were left out in turn
};

// The pair of widths whose left-out samples are predicted best in the error model's sense, among those that do not
// predict them worse than the material alone does in plain squares, which is what a rendering shows.
// members: lumitexels of the material; at most some thousand of them are tried.
PriorChoice choose_prior(const Observations& observations, const std::vector<std::size_t>& members, const std::vector<Brdf>& basis,
                         const Brdf& material, const ErrorModel& error);
inline PriorChoice choose_prior(const Observations& observations, const std::vector<std::size_t>& members,
                                const std::vector<Brdf>& basis, const ErrorModel& error) {
  return choose_prior(observations, members, basis, basis[0], error);
}

}  // namespace lumitexel
