// A model drawn forward, point by point, without casting rays from the camera: what a dense cloud of measured points
// needs no surface for. The light is that of lamps, with shadows (rays from the points); no environment, no bounces.
//
// Every point (surface_points.h) is lit with its own BRDF and normal, projected, and drawn as an ellipse: a Gaussian
// over its texel's parallelogram, seen through the camera, and over the pixel (Zwicker, Pfister, van Baar, Gross 2001,
// "Surface Splatting"). Twice over: first the depths, of the points' tangent planes, then the light of those that lie
// no farther than one spacing of their texels behind the nearest. A pixel shows their weighted mean, so overlapping
// ellipses leave neither holes nor seams; where the picture is finer than the texels the ellipses grow with their
// spacing, where it is coarser they average. All this at three times the resolution, then averaged. A triangle's back
// is black and hides what is behind it, as in ViewRenderer.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/image/image.h"
#include "processing/model/model.h"

namespace lumitexel {

struct SplatView {
  Image radiance;                 // the model's channels; 0 beside the object
  std::vector<std::uint8_t> hit;  // per pixel 1 where a point covers its centre
  std::int64_t points = 0;        // of the model
  std::int64_t shown = 0;         // of them, those that are part of some pixel
};

// The view's own light plays no part unless it is among the lamps. Throws BadInput for a lamp whose channels are not
// the model's. The same bits for any number of threads.
SplatView splat(const Model& model, const View& view, const std::vector<Light>& lamps, FitStage stage);

}  // namespace lumitexel
