// The lens of a captured session: from its own board shots and flat fields, as far as it has any.
#pragma once

#include <map>
#include <optional>

#include "processing/calibration/calibration_options.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/lens/lens_calibration.h"
#include "processing/calibration/lens/vignetting.h"
#include "processing/calibration/radiance_reader.h"
#include "rig/progress.h"

namespace lumitexel {

struct SessionLens {
  CameraModel camera;
  std::optional<LensMatrix> covariance;     // none: the rig's description alone, taken at its word
  std::optional<Vignetting> vignetting;     // only if the flats ask for it
  std::map<int, Eigen::Isometry3d> camera_from_board;  // by placement, of the boards that fit
  std::optional<LensRecord> record;         // of a lens calibrated by this session's boards
};

// A lens calibrated before (in.lens) is taken if this session's boards, which then are check shots, do not say that it has
// changed, and if it has not expired, or they confirm it; five boards or more calibrate the lens themselves, together with what
// the rig's description says of it and how far it says that it may be off.
// Fills in summary.lens and writes lens.json, lens_coverage.png and vignetting.png into `directory` where there is
// something to say.
SessionLens measure_lens(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                         const CalibrationOptions& options, const std::filesystem::path& directory,
                         CalibrationSummary& summary, Progress& progress);

// What the lens now is, and how well it is known, into the summary.
void state_lens(const SessionLens& lens, LensSummary& summary);

}  // namespace lumitexel
