// Whether an object needs normals of its own: photographs are left out, normals and weights are fitted to the others, and what was left out
// is predicted on fitted normals and on the mesh's.
#pragma once

#include "processing/normals/fit_normals.h"

namespace lumitexel {

struct NormalsWorth {
  // By how much fitted normals predict a left-out sample better: difference of its deviance (minus twice the log likelihood).
  double gain = 0, gain_sigma = 0;  // one sigma from how it differs between photographs and parts of the surface
  std::size_t samples = 0;          // left-out samples that were judged

  bool enough() const { return gain > kSigmas * gain_sigma; }  // false where nothing could be judged

 private:
  static constexpr double kSigmas = 3.0;
};

// About every fifth photograph is left out, and some 40,000 lumitexels are judged. Arguments as fit_normals has them.
NormalsWorth normals_worth(const CalibratedSession& session, const LumitexelSet& lumitexels, int atlas_width,
                           const std::vector<std::vector<Brdf>>& bases, const std::vector<int>& label, double median_reflectance,
                           const NormalFitOptions& options);

}  // namespace lumitexel
