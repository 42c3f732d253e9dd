// Which lights that are not the rig's own shine on the spheres with it: a second lamp, or the lamp's image in something that
// mirrors. What they add to the photographs calibration cannot take out; somebody has to move or cover them.
#pragma once

#include <cstddef>
#include <vector>

#include "processing/calibration/light/sphere_shots.h"

namespace lumitexel {

struct StrayLight {
  std::vector<std::size_t> views;                       // in which the spheres show it
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // camera's frame, m; not placed: the unit vector towards it
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // not placed: zero
  bool placed = true;                       // false: too far away for the spheres to tell its distance (MeasuredLight)
  std::vector<HighlightPixel> highlights;   // of all its views
};

// From the strays among the spheres' highlights, each view solved on its own; those that stand in one place in several views are one;
// where a view tells the direction alone, those in one direction from the spheres. In the order of the first view that shows them.
std::vector<StrayLight> locate_stray_lights(const SphereHighlights& seen, const CameraModel& camera,
                                            const RigDescription& rig);

}  // namespace lumitexel
