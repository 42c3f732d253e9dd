#include "tests/protocol/session/synthetic_shots.h"

#include <array>
#include <cmath>

#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr std::array<ShotKind, 6> kKinds{ShotKind::Silhouette, ShotKind::SpheresRing, ShotKind::SpheresPoint,
                                         ShotKind::Object,     ShotKind::Dark,        ShotKind::GrayCard};

// Whole thousandths of a degree: what the registers and the state strip hold.
double place_between(double min, double max, double drawn) {
  return std::round((min + drawn * (max - min)) * 1000.0) / 1000.0;
}

CameraSettings settings_of(int number, const CameraLimits& limits) {
  if (!limits.exposure_choices_s.empty()) {
    const std::size_t choices = limits.exposure_choices_s.size();
    return {limits.exposure_choices_s[static_cast<std::size_t>(number) % choices], limits.gain_step_db * (number % 3)};
  }
  return {1e-6 * (500 + 173 * (number % 11)), 3.0 * (number % 4)};
}

}  // namespace

std::vector<Shot> synthetic_shots(int count, const RigDescription& rig, std::uint64_t seed, int shots_a_place) {
  std::vector<Shot> shots;
  const LightPositionerDescription& arm = rig.light_positioner;
  for (int i = 0; i < count; ++i) {
    CounterRandom place(seed, static_cast<std::uint64_t>(i / shots_a_place));
    Shot shot;
    shot.id = i + 1;
    shot.kind = kKinds[static_cast<std::size_t>(i) % kKinds.size()];
    shot.view = "view_" + std::to_string(i / shots_a_place);
    shot.index = i % shots_a_place;
    shot.camera = quantise(settings_of(i, rig.camera.limits), rig.camera.limits, "synthetic camera");
    shot.turntable_deg = place_between(0.0, 359.0, place.uniform());
    shot.light_azimuth_deg = place_between(arm.azimuth_min_deg, arm.azimuth_max_deg, place.uniform());
    shot.light_elevation_deg = place_between(arm.elevation_min_deg, arm.elevation_max_deg, place.uniform());
    shots.push_back(shot);
  }
  return shots;
}

}  // namespace lumitexel
