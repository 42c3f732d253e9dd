// Pictures of a lens calibration for the report: three channels in [0, 1], about `width_px` wide in the photographs'
// proportions.
#pragma once

#include "processing/calibration/lens/lens_calibration.h"
#include "processing/calibration/lens/vignetting.h"
#include "processing/image/image.h"

namespace lumitexel {

// Every point of the used boards with its residual (seen minus predicted), magnified so that twice the RMS is one
// fiftieth of the width; cells of the coverage grid without a point are shaded. `sightings` are those that were
// calibrated with.
Image coverage_picture(const LensCalibration& calibration, const std::vector<BoardSighting>& sightings, int width_px);

// From where a lens without distortion would put a point to where this one does, on a grid; true to scale if that
// shows, else magnified by a power of ten. `magnification` says by how much.
Image distortion_picture(const CameraModel& camera, int width_px, double* magnification);

// Transmission as gray from `least` (black) to 1, with contours every `step`.
Image vignetting_picture(const Vignetting& vignetting, const CameraModel& camera, int width_px, double least = 0.0,
                         double step = 0.05);

}  // namespace lumitexel
