// Where the axes stand and what is lit: all of a simulated world that changes.
#pragma once

namespace lumitexel {

struct WorldState {
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;
  bool point_light = false, ring_flash = false, backlight = false;
  bool operator==(const WorldState&) const = default;
};

}  // namespace lumitexel
