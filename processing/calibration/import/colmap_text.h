// Cameras and poses in COLMAP's text format.
//
//   cameras.txt   CAMERA_ID MODEL WIDTH HEIGHT PARAMS…
//                 PINHOLE fx fy cx cy | OPENCV fx fy cx cy k1 k2 p1 p2 | SIMPLE_RADIAL f cx cy k
//   images.txt    IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, and a second line of 2-d points (X Y POINT3D_ID)…,
//   often
//                 empty, which is not used. The quaternion and translation are camera_from_world; metres.
//
// Pixels as here: the centre of the top-left pixel is at (0.5, 0.5). Lines that begin with # are comments.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "processing/calibration/lens/camera_model.h"

namespace lumitexel {

struct PosedImage {
  std::string name;
  std::int64_t camera_id = 0;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  std::string place;  // "FILE:LINE" where it stands, for errors found later
};

// By id. Throws BadInput naming `where`, line and field.
std::map<std::int64_t, CameraModel> parse_cameras_txt(std::string_view text, const std::string& where);

// In the file's order. Throws BadInput naming `where`, line and field for anything unreadable, a quaternion whose
// length is more than 1 % off 1, a camera that is not in `cameras`, a name that stands twice, or a file without images.
std::vector<PosedImage> parse_images_txt(std::string_view text, const std::string& where,
                                         const std::map<std::int64_t, CameraModel>& cameras);

}  // namespace lumitexel
