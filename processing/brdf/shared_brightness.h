// Lumitexels whose samples all err by a common factor: paint that is a little thicker here and there, an albedo that varies. Such a spread of
// brightness is not a second material, and a likelihood that does not know it finds as many materials as it may have.
//
// Residuals of a lumitexel are normal with covariance s^2 Sigma + t^2 m m^T: Sigma by the error model but for a part of the channels'
// correlation, m the predictions, t the common factor's standard deviation, s what is left of the error model's scale. Outlying samples count by their robust weights.
#pragma once

#include "processing/brdf/mixture.h"

namespace lumitexel {

// What `parts` (their shares summing to 1) explain better than `whole` alone, in log likelihood, each with the s, t and part of the correlation that suit it best;
// both with the error model of `whole`. weight: how much each of `lumitexels` counts; below 1e-3 not at all.
double gain_beside_shared_brightness(const MaterialModel& whole, const Mixture& parts, const Observations& observations,
                                     const LumitexelList& lumitexels, const std::vector<double>& weight);

}  // namespace lumitexel
