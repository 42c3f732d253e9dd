// How badly a BRDF explains samples: minus twice the log likelihood under an error model, up to a constant. 0 for no samples.
#pragma once

#include <span>

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {

// For many sets of samples, such as lumitexels: what they share is worked out once. `error` must outlive it.
class PreparedMisfit {
 public:
  PreparedMisfit(const Brdf& brdf, const ErrorModel& error);
  double of(std::span<const Observation> samples) const;

 private:
  PreparedBrdf brdf_;
  const ErrorModel& error_;
  double constant_;
};

double misfit(const Brdf& brdf, std::span<const Observation> samples, const ErrorModel& error);
// Every sample counted by its share.
double misfit(const Brdf& brdf, FitSamples samples, const ErrorModel& error);

}  // namespace lumitexel
