// Whether the photographs show the light between surfaces that a model predicts. It may not be there: a mesh may be deeper than the object, a
// surface darker at the slants that no sample has.
//
// A model fitted to the samples as photographed has taken up that light where it goes with a lumitexel's own reflection. What goes
// otherwise with the lamp is left in its residuals, and there the predicted light is sought: of both, what a factor on the lumitexel's prediction would explain
// is taken away, channel by channel, and what remains of the residuals is regressed on what remains of the light, by the given error model with
// outliers counting less. Fits have taken up more than a factor, so that even where all of the light is there the slope is below 1.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"
#include "processing/brdf/project_weights.h"
#include "processing/model/model.h"

namespace lumitexel {

struct IndirectWorth {
  double slope = 0;                                           // of residuals on predicted light; 0 if it is nowhere
  double sigma = std::numeric_limits<double>::quiet_NaN();    // from how photographs differ; NaN with fewer than two
  std::size_t samples = 0;                                    // where light is predicted, that were judged

  static constexpr double kLeastSlope = 0.1, kStandardErrors = 3.0;
  bool enough() const { return slope > kLeastSlope && slope > kStandardErrors * sigma; }  // false of what is no number
};

// before: samples as photographed, with their views, which `model`'s last functions and `weights` were fitted to. without: the same samples less the predicted
// light. label, weights: of each lumitexel. The same bits for any number of threads.
IndirectWorth indirect_worth(const Observations& before, const Observations& without, const Model& model, const std::vector<int>& label,
                             const std::vector<TexelWeights>& weights, const ErrorModel& error);

}  // namespace lumitexel
