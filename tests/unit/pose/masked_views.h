// A lump without any symmetry in masks from all around: an imported session's geometry, with exact poses.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/surface/mesh.h"

namespace lumitexel {

Mesh unsymmetric_lump();  // some 12 cm across

struct MaskedView {
  Eigen::Isometry3d camera_from_mesh = Eigen::Isometry3d::Identity();
  std::vector<std::uint8_t> inside;  // 1 where more than half of the pixel shows the mesh
};

struct MaskedViews {
  CameraModel camera;  // 640 x 480, no distortion
  std::vector<MaskedView> views;
};

// A metre away, from directions drawn with the seed.
MaskedViews masked_views(const Mesh& mesh, std::size_t count, std::uint64_t seed);

}  // namespace lumitexel
