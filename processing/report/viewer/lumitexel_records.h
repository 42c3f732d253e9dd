// What became of every photograph's look at every lumitexel: the samples of a fit gathered once more, beside what the model predicts.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "processing/surface/lumitexel.h"
#include "rig/progress.h"

namespace lumitexel {

// A SampleVerdict as number, or this: a sample that was gathered, but whose light or view is not above the fitted normal, or whose
// numbers are not finite, so that no fit met it (reject_samples.h).
inline constexpr std::uint8_t kBelowFittedNormal = 9;

// Of one view, one entry a lumitexel whose verdict is SampleVerdict::Used, in the lumitexels' order.
struct ViewRecords {
  std::vector<std::uint8_t> verdict;        // of every lumitexel
  std::vector<float> measured, predicted;   // channels interleaved: r = f cos_i, 1/sr; as photographed, light from other surfaces of the object included
  // Only where the fit's error models are on record (LumitexelRecords::weighed), else empty.
  std::vector<float> share;                 // of the sample in the least squares for its texel's weights; a lumitexel's shares sum to 1
  std::vector<float> scales_off;            // root mean square of the channels' residuals over the error model's scales
  std::vector<std::uint8_t> reason;         // 0, or 1 + OutlierReason where Model::outliers_csv lists the sample
};

struct LumitexelRecords {
  int channels = 0;
  bool weighed = false;
  std::vector<std::uint32_t> texel;         // atlas index, rising
  std::vector<Eigen::Vector3d> position;    // in world
  std::vector<std::size_t> used_views;      // indices into session.views
  std::vector<ViewRecords> by_view;         // of each used view
};

// Gathers as fit_model does and predicts with all that the model holds, on its own normals. Shares and scales are by the fit's own error models
// (fit_errors.h). Where light between surfaces was taken out of the samples, it is taken out once more (light_taken.h) and is in `measured` and
// `predicted`; shares and scales are those of samples without it, as in the fit. Throws BadInput if the model was not fitted to this session.
LumitexelRecords lumitexel_records(const Model& model, const CalibratedSession& session, Progress& progress);

// Root mean square of the residuals over a texel's samples and channels, 1/sr, by atlas index; -1 where it has none.
std::vector<float> rms_residual(const LumitexelRecords& records, const Model& model);

}  // namespace lumitexel
