// A model judged by a session's photographs: every view re-rendered and compared over the object's pixels.
//
// Object pixels: not saturated, not defective, and inside the session's mask; in a view without a mask, where the ray
// through the pixel's centre meets the model's mesh. A masked pixel that the mesh misses counts, with a prediction of
// 0. The measured surface alone: those of these pixels whose texel was fitted to samples of its own, not lent to by its
// neighbours. Measures and their pooling over views: processing/model/image_error.h.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/evaluation/image_error.h"
#include "processing/model/model.h"
#include "rig/progress.h"

namespace lumitexel {

struct ViewEvaluation {
  std::string image;
  bool heldout = false;
  std::int64_t object_pixels = 0;
  ImageError error;  // at the last stage
};

// One entry a stage, in the order of kFitStages; nothing for a stage that did not run.
using ErrorByStage = std::array<std::optional<ImageError>, std::size(kFitStages)>;

struct Evaluation {
  FitStage last_stage = FitStage::Single;
  std::string session_key;
  bool same_session = false;  // whether the model was fitted to this session
  ErrorByStage fit, heldout;  // pooled; the errors are NaN if no view is of that kind
  std::vector<ErrorByStage> heldout_views;  // each held-out view by itself
  ErrorByStage heldout_measured;   // of the held-out views the measured surface alone, clipped at that surface's own percentile
  double heldout_measured_share = 0;  // of their object pixels that show it; NaN without any
  std::vector<ViewEvaluation> views;
  std::string provenance_json;  // the model's: what the fit itself found on its samples
};

// The pixels that count, one entry a pixel; `hit` as in RenderedView.
std::vector<std::uint8_t> object_pixels(const RadianceImage& photograph, const std::vector<std::uint8_t>& hit);

// Reads a photograph and checks that it has the view's size and the model's channels; throws BadInput naming it.
RadianceImage read_photograph(const View& view, int channels);

// Holds one view at a time. Throws BadInput if a photograph does not fit its view, Error if the model predicts a value
// that is not finite.
Evaluation evaluate_model(const Model& model, const CalibratedSession& session, Progress& progress);

// The JSON of `lumitexel evaluate --json`, as text; figures that do not exist are null.
std::string evaluation_json(const Evaluation& evaluation);

}  // namespace lumitexel
