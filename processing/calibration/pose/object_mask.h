// Which pixels show the object: dark against the backlight, where the coarse mesh says that it can be.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/image/hdr_merge.h"
#include "processing/surface/mesh.h"

namespace lumitexel {

struct ObjectMask {
  std::vector<std::uint8_t> inside;  // width * height, 1 = object
  bool from_silhouette = false;      // false: no bright panel was found, so the mesh's projection alone decides
  double threshold = 0;              // between the modes, in the silhouette's unit
};

// silhouette: the merged backlight shot. The mesh's projection, widened by margin_px, bounds the object, so that
// spheres and card, dark too, are no object. Throws BadInput if no part of the mesh projects into the picture.
ObjectMask find_object(const MosaicRadiance& silhouette, const Mesh& mesh, const CameraModel& camera,
                       const Eigen::Isometry3d& camera_from_mesh, int margin_px);

}  // namespace lumitexel
