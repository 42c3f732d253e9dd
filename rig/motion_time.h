// How long the rig's axes need from one position to the next.
#pragma once

#include "rig/rig_description.h"
#include "rig/shot.h"

namespace lumitexel {

struct RigPosition {
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;
  bool operator==(const RigPosition&) const = default;
};

RigPosition position_of(const Shot& shot);

// The turntable's way round: the shorter one, 0..180.
double turn_between_deg(double from_deg, double to_deg);

// As the sequencer moves: one axis after the other, each with its settling; an axis that need not move costs nothing.
double sequential_motion_s(const RigPosition& from, const RigPosition& to, const RigDescription& rig);

// What no rig of these speeds can beat: all axes at once at full speed, no settling.
double fastest_motion_s(const RigPosition& from, const RigPosition& to, const RigDescription& rig);

}  // namespace lumitexel
