// A fluted vase with a domed lid: closed, without handles, mildly concave at foot and neck, its surface hammered by a
// fine relief that a scan does not show.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "processing/surface/mesh.h"

namespace lumitexel {

struct VaseOptions {
  double size_m = 0.16;                                 // height
  Eigen::Vector3d centre_in_table = Eigen::Vector3d::Zero();  // half-way up the axis, which is table +z
  double relief_rms_m = 0.0001;                         // of the displacement along the normal
  std::uint64_t seed = 1;
};

// The true surface, 300,000 triangles, and its normals.
Mesh vase(const VaseOptions& options);
// The same without relief, in 28,000 triangles: what a scanner and its software would make of it.
Mesh vase_scan(const VaseOptions& options);

}  // namespace lumitexel
