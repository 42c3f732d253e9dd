// Where the axes stand, what is lit and what stands before the camera: all of a simulated world that changes.
#pragma once

namespace lumitexel {

struct WorldState {
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;
  bool point_light = false, ring_flash = false, backlight = false;
  int board = 0;            // placement of the calibration board, which then is alone before the camera; 0: none
  bool flat_field = false;  // an evenly lit diffuser before the lens
  double lamp_strength = 1;      // of the point light, against its strength at the first shot
  double sensor_warming_k = 0;   // above the sensor's temperature at the first shot
  bool operator==(const WorldState&) const = default;
};

}  // namespace lumitexel
