// The line of spheres from the viewing rays towards their centres (the paper's section on the light source's
// position, eq. 1 to 5).
//
// Centres c_i = d_i * lambda_i along unit rays d_i from the camera obey c_(i-1) - 2 c_i + c_(i+1) = 0. Crossing that
// with one of the three rays removes its depth and leaves a linear relation between the other two:
//   x d_i:      lambda_(i-1) (d_(i-1) x d_i)     + lambda_(i+1) (d_(i+1) x d_i)     = 0
//   x d_(i-1):  lambda_(i+1) (d_(i+1) x d_(i-1)) - 2 lambda_i   (d_i x d_(i-1))     = 0
// All these cross products point along the normal of the plane that holds camera and line, so one component tells
// everything: the one in which they are largest, since the others may vanish (for a line parallel to the image's rows
// the x component does). The depths, up to a common factor, solve all relations by least squares; the factor follows
// from the known spacing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/calibration/light/sphere_reflection.h"

namespace lumitexel {

struct SphereLine {
  Eigen::Vector3d first_centre = Eigen::Vector3d::Zero();  // camera frame, m
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();    // unit, from the first to the last
  double spacing_m = 0, radius_m = 0;
  int count = 0;

  MirrorSphere sphere(int i) const { return {first_centre + i * spacing_m * direction, radius_m}; }
};

// rays: at least three unit directions in the camera's frame, in order along the line. Throws BadInput if there are
// fewer, or if rays coincide or put a sphere behind the camera.
SphereLine sphere_line_from_rays(const std::vector<Eigen::Vector3d>& rays, double spacing_m, double radius_m);
// The same where some spheres are not seen: each ray's place along the line, ascending. The line has as many spheres as the last
// one's place says.
SphereLine sphere_line_from_rays(const std::vector<Eigen::Vector3d>& rays, const std::vector<int>& places, double spacing_m,
                                 double radius_m);

}  // namespace lumitexel
