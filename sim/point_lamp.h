// The point light as it really shines: where it stands, how large it is, where it points and how its light falls off to
// the sides.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/simulated_world.h"

namespace lumitexel {

// A small part of a lamp, in a frame that its user chooses.
struct Emitter {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Array3d w_per_sr = Eigen::Array3d::Zero();  // along the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   // unit
  double exponent = 0;                               // intensity goes with the cosine to the axis to this power; 0: evenly

  // Towards a point that lies along the unit vector `away` from the emitter.
  Eigen::Array3d intensity_along(const Eigen::Vector3d& away) const;
  Emitter in(const Eigen::Isometry3d& frame_from_rig) const;
};

// The lamp's axis in the rig: at the arm's true pivot, tilted by lamp_pattern_tilt_deg about the lamp's own level and
// upright directions.
Eigen::Vector3d lamp_axis_in_rig(const SimulatedWorld& world, double azimuth_deg, double elevation_deg);

// One emitter, or, for a lamp with a radius, kLampEmitters of equal strength over its disc, which faces along the axis.
inline constexpr int kLampEmitters = 48;
std::vector<Emitter> point_lamp_in_rig(const SimulatedWorld& world, double azimuth_deg, double elevation_deg);

std::vector<Emitter> ring_flash_in_rig(const SimulatedWorld& world);

}  // namespace lumitexel
