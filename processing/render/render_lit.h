// A model in the light of lamps and an environment, with light between its surfaces: rendered pass by pass until it is
// good enough (path_tracer.h says what is computed, progressive.h how the noise is told).
//
// The picture is a function of the model, the view's camera, the lighting, the options and the number of samples per
// pixel: any number of threads computes the same bits. The pixel is a square, evenly weighted.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>

#include "drivers/clock.h"
#include "processing/render/path_tracer.h"
#include "rig/progress.h"

namespace lumitexel {

// Whichever comes first ends the work.
struct RenderLimits {
  int samples_per_pixel = 64;
  // From the call on. No pass over the picture is begun that, by the time of those before, would not be done in time;
  // the first one always is.
  double time_s = std::numeric_limits<double>::infinity();
  double noise = 0;  // 0: not asked for. As in ProgressivePicture::noise; believed from 16 samples on
};

struct LitOptions {
  FitStage stage = FitStage::Normal;  // all that the model holds
  PathOptions path;
  RenderLimits limits;
};

enum class RenderEnd { Samples, Time, Noise, Stopped };
const char* to_string(RenderEnd end);  // "samples", "time", "noise", "stopped"

struct LitView {
  Image radiance;                 // the model's channels
  std::vector<std::uint8_t> hit;  // per pixel 1 where any ray meets the mesh
  int samples_per_pixel = 0;
  std::optional<double> noise;       // of the result
  std::int64_t dropped_samples = 0;  // that were not finite; they count as black
  double seconds = 0;
  RenderEnd end = RenderEnd::Samples;
};

// The view's own light plays no part unless it is among the lamps. Once `stop` is requested no further pass is begun: what is done by then is
// the result, one pass at least. Throws BadInput for a lamp or an environment whose channels are not the model's, and for limits or bounces that
// make no sense.
LitView render_lit(const Model& model, const View& view, const Lighting& lighting, const LitOptions& options,
                   Progress& progress, const Clock& clock, std::stop_token stop = {});

// The environment alone, without a word about how far it is.
LitView render_environment(const Model& model, const View& view, const Environment& environment,
                           const LitOptions& options = {});

}  // namespace lumitexel
