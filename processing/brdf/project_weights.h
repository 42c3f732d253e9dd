// Every texel its own mixture of its material's basis (section 8 of the paper, eq. 12): non-negative least squares over
// all samples and channels, with a Gaussian prior around the material itself.
//
// With a handful of samples and more bases than that, plain least squares predicts unseen photographs worse than the
// material alone does. The prior says how far texels of one material differ; its width is not chosen by hand but by leaving
// out one sample after the other and predicting it: where texels do not differ, the prior is narrow and projection returns the material.
#pragma once

#include <functional>
#include <vector>

#include "processing/brdf/error_model.h"
#include "processing/brdf/nnls.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

struct TexelWeights {
  std::vector<float> weight;     // of each basis, >= 0
  float relative_sigma = 0;      // one-sigma of the predicted reflectance, relative, from the posterior
};

// Weights of one texel. basis[0] is the material itself. prior_width: standard deviation of each weight about
// (1, 0, 0, …); infinity is the paper's plain non-negative least squares.
TexelWeights project_texel(std::span<const Observation> samples, int channels, const std::vector<LafortuneBrdf>& basis,
                           const ErrorModel& error, double prior_width);

struct PriorChoice {
  double width = 0;                  // the best of kPriorWidths
  std::vector<double> left_out_error;  // per width: mean of the capped squared deviations of left-out samples
  std::size_t samples = 0;           // that were left out in turn
};
inline constexpr double kPriorWidths[] = {0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 2.0};

// members: lumitexels of the material; at most some thousand of them are tried.
PriorChoice choose_prior_width(const Observations& observations, const std::vector<std::size_t>& members,
                               const std::vector<LafortuneBrdf>& basis, const ErrorModel& error);

}  // namespace lumitexel
