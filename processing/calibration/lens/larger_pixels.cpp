#include "processing/calibration/lens/larger_pixels.h"

namespace lumitexel {

CameraModel with_larger_pixels(CameraModel camera, int block) {
  camera.width_px /= block;
  camera.height_px /= block;
  for (double* length : {&camera.focal_x_px, &camera.focal_y_px, &camera.principal_x_px, &camera.principal_y_px}) *length /= block;
  return camera;
}

}  // namespace lumitexel
