#include "sim/point_lamp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

struct LampFrame {
  Eigen::Vector3d level, upright, axis;
};

LampFrame frame_of_arm(const SimulatedWorld& world, const Eigen::Vector3d& lamp) {
  const Eigen::Vector3d pivot = world.rig.light_positioner.pivot_in_rig + world.settings.arm_offset_m;
  LampFrame frame;
  frame.axis = (pivot - lamp).normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(frame.axis);
  // Straight above the pivot every direction is level.
  frame.level = level.norm() > 1e-9 ? level.normalized() : Eigen::Vector3d::UnitX();
  frame.upright = frame.axis.cross(frame.level);
  return frame;
}

Eigen::Vector3d tilted_axis(const SimulatedWorld& world, const LampFrame& frame) {
  const Eigen::Vector2d tilt = world.settings.lamp_pattern_tilt_deg * (std::numbers::pi / 180.0);
  return Eigen::AngleAxisd(tilt.y(), frame.upright) * (Eigen::AngleAxisd(tilt.x(), frame.level) * frame.axis);
}

}  // namespace

Eigen::Array3d Emitter::intensity_along(const Eigen::Vector3d& away) const {
  if (exponent == 0.0) return w_per_sr;
  return w_per_sr * std::pow(std::max(axis.dot(away), 0.0), exponent);
}

Emitter Emitter::in(const Eigen::Isometry3d& frame_from_rig) const {
  return {frame_from_rig * position, w_per_sr, frame_from_rig.linear() * axis, exponent};
}

Eigen::Vector3d lamp_axis_in_rig(const SimulatedWorld& world, double azimuth_deg, double elevation_deg) {
  return tilted_axis(world, frame_of_arm(world, world.point_light_in_rig(azimuth_deg, elevation_deg)));
}

std::vector<Emitter> point_lamp_in_rig(const SimulatedWorld& world, double azimuth_deg, double elevation_deg) {
  const SimulationSettings& settings = world.settings;
  const Eigen::Vector3d centre = world.point_light_in_rig(azimuth_deg, elevation_deg);
  const LampFrame frame = frame_of_arm(world, centre);
  const Eigen::Vector3d axis = tilted_axis(world, frame);
  if (settings.lamp_radius_m == 0.0) {
    return {{centre, settings.point_light_w_per_sr, axis, settings.lamp_pattern_exponent}};
  }
  // Vogel's spiral: equal areas, no direction preferred.
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Emitter> emitters;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < kLampEmitters; ++i) {
    const double radius = settings.lamp_radius_m * std::sqrt((i + 0.5) / kLampEmitters), angle = golden_angle * i;
    const Eigen::Vector3d place =
        centre + radius * (std::cos(angle) * frame.level + std::sin(angle) * frame.upright);
    emitters.push_back({place, settings.point_light_w_per_sr / kLampEmitters, axis, settings.lamp_pattern_exponent});
    mean += place / kLampEmitters;
  }
  for (Emitter& emitter : emitters) emitter.position += centre - mean;  // so that the truth is the light's centroid
  return emitters;
}

std::vector<Emitter> ring_flash_in_rig(const SimulatedWorld& world) {
  const double share = 1.0 / world.settings.ring_flash_emitters;
  std::vector<Emitter> ring;
  for (const Eigen::Vector3d& position : world.ring_emitters_in_rig()) {
    ring.push_back({position, share * world.settings.ring_flash_w_per_sr});
  }
  return ring;
}

}  // namespace lumitexel
