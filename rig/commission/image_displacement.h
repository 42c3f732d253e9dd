// How far an axis is off a reference position, told from pictures alone, however its encoder sees it.
//
// Around the reference, I(p) ~ I(0) + p dI, with dI from a second picture a known step away. Then
// p = <dI, I - I(0)> / <dI, dI>, each pixel weighted by one over its variance, over the pixels where dI stands clear of
// the noise. Good for displacements up to about the step; beyond it the sign is right and the size is an under-estimate.
// The picture is not quite linear in p: kCurvature of the result is to be reckoned with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rig/commission/frame_statistics.h"

namespace lumitexel {

inline constexpr double kCurvature = 0.05;  // relative; seen on simulated pictures at a third of the step: 0.03

class DisplacementGauge {
 public:
  // reference and stepped: mean pictures of `frames` frames each; variance_dn2: of one frame, per pixel.
  // Throws Error if fewer than 50 pixels change visibly with the step.
  DisplacementGauge(std::vector<float> reference, const std::vector<float>& stepped, double step, int frames,
                    const std::vector<float>& variance_dn2);

  // In the step's unit.
  double displacement(Samples picture) const;
  // One sigma of displacement() of a single frame.
  double resolution() const;

 private:
  std::vector<float> reference_, weighted_change_;  // change per unit over variance; 0 where it is not visible
  double information_ = 0;
};

// The mean of several frames.
std::vector<float> mean_picture(const std::vector<std::vector<std::uint16_t>>& frames);

}  // namespace lumitexel
