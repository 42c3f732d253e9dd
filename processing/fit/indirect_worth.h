// Whether the photographs show the light between surfaces that a model predicts (indirect_trial.h). It may not be there: a mesh may be
// deeper than the object, a surface darker at the slants that no sample has.
#pragma once

#include <cstddef>
#include <limits>

namespace lumitexel {

struct IndirectWorth {
  double slope = 0;                                         // of residuals on predicted light: 1 if all of it is there, 0 if none
  double sigma = std::numeric_limits<double>::quiet_NaN();  // as photographs differ; what all share, as a mesh too deep, is not in it. NaN: not judged
  std::size_t photographs = 0, samples = 0;                 // that judged

  static constexpr double kLeastSlope = 0.25, kStandardErrors = 3.0;
  static constexpr std::size_t kFewestPhotographs = 6;  // with fewer, three standard errors are no rare thing
  bool judged() const { return sigma == sigma && photographs >= kFewestPhotographs; }
  bool enough() const { return judged() && slope > kLeastSlope && slope > kStandardErrors * sigma; }
};

}  // namespace lumitexel
