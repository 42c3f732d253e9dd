// A backlit picture of a mesh, sampled finely along its rim: the truth that poses are tested against.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/image/hdr_merge.h"
#include "processing/surface/mesh.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

struct DarkDisc {
  Eigen::Vector2d centre_px;
  double radius_px;
};

struct BacklitScene {
  const Mesh& mesh;
  const RayScene& rays;  // of the mesh
  CameraModel camera;
  Eigen::Isometry3d camera_from_mesh;
  std::vector<DarkDisc> discs;  // other dark things
  double panel_e = 10000.0;     // electrons a pixel of the panel gathers; 0: no noise
  double read_noise_e = 4.0;
  int subsamples = 8;           // per axis of a pixel on the rim
};

// Mono; the panel's level is 1.
MosaicRadiance backlit_view(const BacklitScene& scene, std::uint64_t seed);

// The rig of config/rigs/simulated.toml: 11800 px focal length at 4096 x 3072, or smaller by a factor; a distorting lens.
CameraModel bench_camera(double scale);
// The camera a metre from the table's origin, 30 degrees above it.
Eigen::Isometry3d bench_camera_from_table();

// A mesh seen as if it had been turned by `turn_deg` about the axis and shifted, in the camera's axes, about its box's middle.
Eigen::Isometry3d disturbed(const Eigen::Isometry3d& camera_from_mesh, const Mesh& mesh, const Eigen::Vector3d& turn_deg,
                            const Eigen::Vector3d& shift_m);

struct PoseError {
  double turn_deg = 0, shift_m = 0;  // of the box's middle
  Eigen::Matrix<double, 6, 1> step;  // from truth to estimate: rad, m; axes of the camera
};
PoseError pose_error(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth, const Mesh& mesh);

}  // namespace lumitexel
