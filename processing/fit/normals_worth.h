// Whether an object needs normals of its own: photographs are left out, everything is fitted to the others as a fit would do it
// (normal_trial.h), once on the mesh's normals and once on fitted ones, and what was left out is predicted both ways.
#pragma once

#include <cmath>
#include <cstddef>

namespace lumitexel {

struct NormalsWorth {
  // By how much fitted normals predict a left-out sample better: difference of its deviance (minus twice the log likelihood) under the fit's
  // given error model.
  double gain = 0, gain_sigma = 0;  // one sigma from how it differs between photographs and blocks of the surface; what all
                                    // blocks of a photograph share, as its pose, is not in it
  std::size_t samples = 0;          // left-out samples that were judged

  bool enough() const { return gain > kLeastGain && gain > gain_sigma; }  // false where nothing could be judged

  // Either way, so that other photographs need not be left out as well. Never without a sigma: then nothing could be judged.
  bool is_clear() const { return gain_sigma > 0.0 && std::abs(gain - kLeastGain) > kClear * gain_sigma; }

  static constexpr double kClear = 3.0;       // sigmas: with two, five looks would end too early by chance in one trial of five or so
  static constexpr double kLeastGain = 0.02;  // a hundredth of what one sigma costs in each channel or so: less is not worth a map
};

}  // namespace lumitexel
