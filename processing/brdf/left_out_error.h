// How well a mixture predicts samples that it was not shown: each of a lumitexel's samples from a material chosen by the others alone.
#pragma once

#include "processing/brdf/choice.h"
#include "processing/brdf/mixture.h"

namespace lumitexel {

// As a rendering shows errors: in plain squares, with values clipped at a level so that a few highlights do not decide alone, and in
// squares of square roots, where dark materials count too. 1/sr squared, and 1/sr.
struct SquaredError {
  double clipped = 0, root = 0;
  SquaredError& operator+=(const SquaredError& other);
};

// Of one sample, summed over channels.
SquaredError squared_error(const ChannelValues& predicted, const Observation& sample, int channels, double clip);

// The 99.9th percentile of the lumitexels' reflectances.
double clip_level(const Observations& observations, const LumitexelList& lumitexels);

// One entry a lumitexel, summed over its samples; the prediction is the mean over materials, weighted by their probability given the
// lumitexel's other samples. Lumitexels with one sample have none to choose by and count as zero.
std::vector<SquaredError> left_out_errors(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                          double clip);

// Both kinds of error as shares of `total`, added, per lumitexel.
std::vector<double> relative_errors(const std::vector<SquaredError>& errors, const SquaredError& total);
SquaredError total_error(const std::vector<SquaredError>& errors);

// Sum of a - b over its standard error (choice.h); 0 if the two are the same.
double excess_in_standard_errors(const std::vector<double>& a, const std::vector<double>& b, Judges judges = Judges::Lumitexels);

}  // namespace lumitexel
