// How lamp and sensor change in the course of a session, as a function of the frame's name (the id of its shot) and of
// nothing else, so that a resumed session finds them as an uninterrupted one would.
#pragma once

#include <cstdint>

#include "sim/bench_behaviour.h"

namespace lumitexel {

// Share of the point light's strength at the first shot: 1 + lamp_drift * s(u), with u going from 0 at shot 1 to 1 after
// lamp_drift_shots, s an exponential warming up with a slow swing on it, s(0) = 0, s(1) = 1.
double lamp_strength_at(const BenchBehaviour& behaviour, std::uint64_t frame_key);

// Kelvin above sensor_temperature_c: an exponential from 0 at shot 1 to sensor_warming_k after sensor_warming_shots.
double sensor_warming_at(const BenchBehaviour& behaviour, std::uint64_t frame_key);

}  // namespace lumitexel
