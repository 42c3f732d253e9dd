// A ball photographed from far away with a long lens: its outline, its normals, and the direction of a distant light that
// it mirrors.
//
// Directions are in the viewer's frame: x to the right, y up, z towards the viewer (not the camera's frame of the rest of
// the program, whose y points down and z away); the camera counts as infinitely far. A ball under a perspective that
// matters is no case for this file: see sphere_reflection.h.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "processing/image/image.h"

namespace lumitexel {

struct BallInPicture {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double radius_px = 0;
  double outline_rms_px = 0;  // of the mask's edge about the circle: 0.3 for a circle cut into whole pixels

  // Unit normal of the ball where a pixel sees it; none outside.
  std::optional<Eigen::Vector3d> normal(const Eigen::Vector2d& pixel) const;
};

// From a mask whose first channel is above half its maximum on the ball. Centre and radius by the mask's moments. Throws
// BadInput if the mask is empty, touches the picture's edge, or is no disc (outline off by more than 2 % of the radius).
BallInPicture ball_of_mask(const Image& mask);

struct MirroredDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit, towards the light
  double sigma_rad = 0;                                  // from the highlight's shape and the outline
  Eigen::Vector2d highlight_px = Eigen::Vector2d::Zero();
  int clipped = 0;     // pixels at the maximum: they count as much as one another, the flanks by their value
  int rivals = 0;      // other connected highlights at least half as large
};

// The largest connected highlight on a mirror ball (mean over channels above half the picture's brightest), its centroid,
// and the direction d = 2 (n . z) n - z. The sigma is how far the centroid moves between thresholds of a quarter and three
// quarters, and the outline's error. `maximum`: code value at which the camera clips. None if nothing on the ball is
// brighter than a tenth of the maximum.
std::optional<MirroredDirection> mirrored_direction(const Image& picture, const BallInPicture& ball, float maximum);

}  // namespace lumitexel
