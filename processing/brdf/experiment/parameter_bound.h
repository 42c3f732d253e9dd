// How well anybody could know the five materials' parameters: Cramer and Rao's bound, for Gaussian noise of the world's size and one shape for
// all channels.
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

// For somebody who is told which lumitexel is of which material. One entry a material.
std::vector<MaterialBound> bound_with_labels(const FiveMaterials& world);

// For somebody who is not, nor how many of each there are. The information of the mixture is the mean of the outer product of its score,
//
//   d log p / d theta_k = r_k d log p_k / d theta_k,     r_k: the probability of material k given the lumitexel's samples,
//
// over noise and labels, here over draws of both on the world's own geometries: which knows the bound to about 1 %.
std::vector<MaterialBound> bound_without_labels(const FiveMaterials& world);

// The chance that all of N and kd come out within a share of their truth for an unbiased, normally distributed estimator that reaches the bound, its
// errors taken for independent.
double chance_within(double share, const std::vector<MaterialBound>& bound, const std::vector<Brdf>& truth);

}  // namespace lumitexel
