// Pinhole camera with Brown-Conrady distortion (OpenCV's k1, k2, p1, p2). The camera looks along +z, y down; the
// centre of the top-left pixel is at (0.5, 0.5).
#pragma once

#include <Eigen/Core>

namespace lumitexel {

struct CameraModel {
  int width_px = 0, height_px = 0;
  double focal_x_px = 0, focal_y_px = 0, principal_x_px = 0, principal_y_px = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;

  // Pixel of a point in the camera's frame; z must be > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& x_in_camera) const;
  // Unit direction in the camera's frame through a pixel. The distortion is inverted by Newton's method; beyond
  // the radius where the distortion folds over, the nearest direction that it reached is returned.
  Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;
  bool contains(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < width_px && pixel.y() < height_px;
  }
};

}  // namespace lumitexel
