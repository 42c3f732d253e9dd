// How much stronger the dark current was in a frame than in its dark, told by the frame itself.
//
// Goesele, Heidrich, Seidel, "Entropy-based dark frame subtraction" (2001): subtracting s * dark leaves the least entropy
// at the right s, because every hot pixel that is left over or dug out adds values that the scene does not have. Here the
// entropy is that of  (sample - s * excess - median of its neighbours of the same colour) / noise  over the hot pixels
// that lie in smooth, unsaturated surroundings: others know nothing of s. With the density smoothed by a Gaussian it is a
// differentiable function of s, minus a mean log likelihood; hence sub-DN accuracy and the sandwich standard deviation.
#pragma once

#include <vector>

#include "processing/image/dark_frames.h"

namespace lumitexel {

struct DarkScale {
  double scale = 1.0, sigma = 0.0;  // best factor and its standard deviation; 1 and 0 where not determined
  bool determined = false;          // enough hot pixels spoke
  bool needed = false;              // it differs from 1 by more than kDarkScaleSigmas of its own
  int pixels = 0;                   // that were asked
};

inline constexpr double kDarkScaleSigmas = 3.0;
inline constexpr int kFewestDarkScalePixels = 12;

struct DarkedFrame {
  const Frame* frame = nullptr;
  const MasterDark* dark = nullptr;  // of the same size; its temperature, and with dark_scale its exposure, may differ
};

// One common factor for frames that were taken at one temperature and darks at one other. Searched from 1/20 to 20.
// Throws BadInput if there is no frame or a size differs.
DarkScale fit_dark_scale(const std::vector<DarkedFrame>& frames, const LinearSensor& sensor);

// The dark with its current multiplied. Only current that stands out of the dark's noise is a pixel's own (shrunk by
// James and Stein's factor); the rest is the typical pixel's, so that offsets that do not depend on temperature stay.
MasterDark scaled_dark(const MasterDark& dark, const DarkScale& scale, const LinearSensor& sensor);

}  // namespace lumitexel
