// What a simulated bench does that the rig's description does not say.
#pragma once

#include <cstdint>

namespace lumitexel {

struct BenchBehaviour {
  std::uint64_t seed = 1;
  double lamp_settle_s = 0.1;
  double sensor_temperature_c = 25.0;
  // Changes over the session (sim/session_drift.h): of the point light's strength relatively, of the sensor's temperature.
  double lamp_drift = 0.0, sensor_warming_k = 0.0;
  int lamp_drift_shots = 100, sensor_warming_shots = 100;
  // The true state of every exposure goes over the frame's first pixels (sim/state_strip.h).
  bool state_strip = false;
  // The turntable's mechanics beyond its encoder: slack between the two, and a swing that dies away after every stop.
  double turntable_backlash_deg = 0.0;
  double turntable_swing_deg = 0.0, turntable_swing_decay_s = 0.1, turntable_swing_hz = 8.0;
};

}  // namespace lumitexel
