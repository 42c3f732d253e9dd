#include "rig/motion_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumitexel {
namespace {

struct AxisMove {
  double travel_s, settle_s;
};

std::array<AxisMove, 3> moves(const RigPosition& from, const RigPosition& to, const RigDescription& rig) {
  const double turn_s = turn_between_deg(from.turntable_deg, to.turntable_deg) / rig.turntable.speed_deg_per_s;
  const LightPositionerDescription& arm = rig.light_positioner;
  const auto arm_s = [&](double a_deg, double b_deg) { return std::abs(a_deg - b_deg) / arm.speed_deg_per_s; };
  return {{{turn_s, rig.turntable.settle_s},
           {arm_s(from.light_azimuth_deg, to.light_azimuth_deg), arm.settle_s},
           {arm_s(from.light_elevation_deg, to.light_elevation_deg), arm.settle_s}}};
}

}  // namespace

RigPosition position_of(const Shot& shot) {
  return {shot.turntable_deg, shot.light_azimuth_deg, shot.light_elevation_deg};
}

double turn_between_deg(double from_deg, double to_deg) {
  return std::abs(std::remainder(to_deg - from_deg, 360.0));
}

double sequential_motion_s(const RigPosition& from, const RigPosition& to, const RigDescription& rig) {
  double sum_s = 0.0;
  for (const AxisMove& move : moves(from, to, rig)) {
    if (move.travel_s > 0.0) sum_s += move.travel_s + move.settle_s;
  }
  return sum_s;
}

double fastest_motion_s(const RigPosition& from, const RigPosition& to, const RigDescription& rig) {
  double longest_s = 0.0;
  for (const AxisMove& move : moves(from, to, rig)) longest_s = std::max(longest_s, move.travel_s);
  return longest_s;
}

}  // namespace lumitexel
