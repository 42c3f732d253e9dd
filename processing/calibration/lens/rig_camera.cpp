#include "processing/calibration/lens/rig_camera.h"

namespace lumitexel {

CameraModel camera_model_of(const CameraDescription& camera) {
  const LensDescription& lens = camera.lens;
  return {camera.limits.width_px, camera.limits.height_px, lens.focal_x_px, lens.focal_y_px, lens.principal_x_px,
          lens.principal_y_px,    lens.k1,                 lens.k2,         lens.p1,         lens.p2};
}

}  // namespace lumitexel
