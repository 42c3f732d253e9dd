// How ln p of one lumitexel's samples changes with all that a mixture of materials has, where nobody says which material it is of.
//
// The noise is Gaussian, a known part of the prediction in every channel. Unknowns: each material's parameters in the order of its
// BrdfParameters, one material after another; then all shares but the last's.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "processing/brdf/brdf_slopes.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// One lumitexel's geometries under one material: all that does not depend on what was measured.
struct PredictedSamples {
  std::vector<SampleValues> value;
  std::vector<SampleSlopes> relative_slope;  // of ln value, a row a channel
};

PredictedSamples predicted_samples(const BrdfSlopes& material, std::span<const Observation> samples);

struct MixtureScore {
  std::vector<double> probability;  // of each material, given the samples
  Eigen::MatrixXd if_known;         // a column a material: the slope of ln (share p) for who knows that it is this one
  Eigen::VectorXd slope() const;    // of ln p: the columns' mean, by probability
};

// values: of every sample, a number a channel. shares: positive, sum 1.
MixtureScore mixture_score(const std::vector<PredictedSamples>& materials, const std::vector<double>& shares, double relative_sigma,
                           const std::vector<SampleValues>& values);

}  // namespace lumitexel
