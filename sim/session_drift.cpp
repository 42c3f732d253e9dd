#include "sim/session_drift.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

// Time constants in the course: by its end a warming is 95 % over, were it to go on.
constexpr double kTimeConstants = 3.0;
constexpr double kSwing = 0.15, kSwings = 2.0;

double progress(std::uint64_t frame_key, int shots) {
  const double taken = frame_key > 0 ? static_cast<double>(frame_key - 1) : 0.0;
  return std::min(taken / shots, 1.0);
}

double warmed_up(double u) { return std::expm1(-kTimeConstants * u) / std::expm1(-kTimeConstants); }

}  // namespace

double lamp_strength_at(const BenchBehaviour& behaviour, std::uint64_t frame_key) {
  if (behaviour.lamp_drift == 0.0) return 1.0;
  const double u = progress(frame_key, behaviour.lamp_drift_shots);
  return 1.0 + behaviour.lamp_drift * (warmed_up(u) + kSwing * std::sin(2.0 * std::numbers::pi * kSwings * u));
}

double sensor_warming_at(const BenchBehaviour& behaviour, std::uint64_t frame_key) {
  if (behaviour.sensor_warming_k == 0.0) return 0.0;
  return behaviour.sensor_warming_k * warmed_up(progress(frame_key, behaviour.sensor_warming_shots));
}

}  // namespace lumitexel
