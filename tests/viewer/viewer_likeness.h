// How like the ray tracer's picture the viewer's is.
#pragma once

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model_surface.h"
#include "tests/viewer/browser_pictures.h"

namespace lumitexel {

struct Likeness {
  int object_pixels = 0;  // both meet the mesh
  int same_texel = 0;     // of them, those where both find the same texel the nearest
  int other_outline = 0;  // only one of them meets the mesh
  double white = 0;       // the reference's value that 99 % of the lit object's values do not pass
  double psnr_db = 0;     // over channels of the pixels with the same texel: white^2 over the mean square, nothing clipped
  double worst = 0;       // largest difference among them, over white
};

Likeness likeness(const ModelSurface& surface, const View& view, FitStage stage, const BrowserPicture& picture);

}  // namespace lumitexel
