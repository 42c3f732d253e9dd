// A camera whose pictures are binned.
#pragma once

#include "processing/calibration/lens/camera_model.h"

namespace lumitexel {

// The camera that sees the same through pixels `block` times as large; rows and columns that fill no pixel are cut off.
CameraModel with_larger_pixels(CameraModel camera, int block);

}  // namespace lumitexel
