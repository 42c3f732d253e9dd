// The sensor's noise model measured from a session's own frames.
//
// Two exposures of the same still scene, x1 at t1 and x2 at t2 = a t1, darks subtracted: the difference d = a x1 - x2 has
// no scene in it. Its variance grows with the signal S = x2's expectation,
//     var d = (a + 1) S / g + a^2 v1 + v2,
// where g is in electrons per DN and v1, v2 are the darks' parts: read noise, rounding, dark current and the noise of the
// subtracted means (Janesick, "Photon Transfer", 2007, with frame pairs of unequal exposure). Pixels are binned and weighted by
// what their neighbours see: by the pixel's own signal they would be chosen by their own noise. In a bin, which may span decades of
// signal, signal and variance are means with the same weights; the variance is taken about the mean and trimmed at four
// standard deviations (corrected for what that cuts off of normal noise), so that edges that moved and flickering
// highlights do not count. Lines through all bins and the darks' own variances give g and the read noise at once.
#pragma once

#include <string>
#include <vector>

#include "processing/image/dark_frames.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {

struct SensorValue {
  double value = 0, sigma = 0;  // sigma 0 where not measured
  bool measured = false;        // else `value` is the rig's description
};

struct LinearityPoint {
  double signal_dn = 0, deviation = 0, sigma = 0;  // (a x1 - x2) / x2: relative
  double from_s = 0, to_s = 0;                     // t1, t2
};

struct PhotonTransfer {
  LinearSensor sensor;  // what was measured, and the description where the frames could not tell
  SensorValue electrons_per_dn, read_noise_dn, black_level_dn, clip_dn;
  double gain_read_correlation = 0;     // of the errors of electrons_per_dn and read_noise_dn
  double chi_square_per_freedom = 0;    // of the lines; 0 without light
  double trimmed_share = 0;             // of the differences; 0.00006 for normal noise
  std::vector<LinearityPoint> linearity;
  double largest_nonlinearity = 0, largest_nonlinearity_sigma = 0;  // relative, over `linearity`, of its significant points
  bool looks_linear = true;             // no more of `linearity` stands out by three sigma than chance explains
  std::vector<std::string> notes;       // what could not be measured, and why; what contradicts the description
};

// brackets: each of one still scene at two or more exposures, of the sizes, bits and gain of `darks`. May be empty.
// A value is taken over only where its relative sigma is below 5 %. Throws BadInput where a frame has no dark or differs
// in size from its bracket, or `described` is no sensor.
PhotonTransfer measure_photon_transfer(const std::vector<std::vector<Frame>>& brackets, const DarkLibrary& darks,
                                       const LinearSensor& described);

}  // namespace lumitexel
