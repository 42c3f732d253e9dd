// A photograph, its re-rendering and their difference, ready to be looked at.
#pragma once

#include "processing/calibration/calibrated_session.h"
#include "processing/model/render_view.h"

namespace lumitexel {

struct ViewPictures {
  // sRGB-encoded in [0, 1], cropped to the object, reduced to at most `width_px`. Photograph and rendering share one
  // exposure: `white` is the radiance shown as white, the photograph's 99th percentile over the object.
  Image photograph, rendering, difference;
  double white = 1;
};

// The difference is the mean over channels of rendering minus photograph, on the scale of false_colour: full colour at
// this share of white.
inline constexpr double kDifferenceRange = 0.3;

// position in [-1, 1]: from blue (the rendering is too dark) over near-white to red (too bright).
std::array<float, 3> false_colour(double position);

// ViewPictures::white of the view.
double shown_white(const ViewRenderer& renderer, const View& view, int channels);

ViewPictures make_view_pictures(const ViewRenderer& renderer, const View& view, int channels, FitStage stage,
                                int width_px);

}  // namespace lumitexel
