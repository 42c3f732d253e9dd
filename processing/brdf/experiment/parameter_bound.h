// How well anybody could know the five materials' parameters: Cramer and Rao's bound, for Gaussian noise of the world's size, which is known, and
// one lobe shape for all channels.
#pragma once

#include <array>
#include <vector>

#include "processing/brdf/experiment/five_materials.h"

namespace lumitexel {

// The smallest standard deviations that an unbiased estimator of one material could have.
struct MaterialBound {
  double log_exponent = 0;
  std::array<double, 3> diffuse{};
};

// For somebody who is told which lumitexel is of which material. One entry a material. Every material has lumitexels in the world.
std::vector<MaterialBound> bound_with_labels(const FiveMaterials& world);

// For somebody who is told neither labels nor shares: the bound above, wider by as much as not knowing them widens it on average over who is whose.
// By Louis' identity (1982) the information is that with labels less what is missing,
//
//   I = sum_i sum_k pi_k I_ik  -  sum_i E[ sum_k r_k (S_k - S)(S_k - S)^T ],     S = sum_k r_k S_k,
//
// with lumitexel i's share pi_k and information I_ik under material k, its probability r_k given the samples, and mixture_score.h's S_k. The
// expectation is a mean over draws of the noise, two a lumitexel and material: one world's answer is known to 1 % and less.
std::vector<MaterialBound> bound_without_labels(const FiveMaterials& world);

// The chance that all of N and kd come out within a share of their truth for an unbiased, normally distributed estimator that reaches the bound, its
// errors taken for independent.
double chance_within(double share, const std::vector<MaterialBound>& bound, const std::vector<Brdf>& truth);

}  // namespace lumitexel
