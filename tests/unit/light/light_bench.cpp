#include "tests/unit/light/light_bench.h"

namespace lumitexel {
namespace {
constexpr double kSigma_px = 0.005;
}

LightBench bench_at(const Eigen::Vector3d& offset) {
  LightBench bench;
  bench.spheres = simulated_sphere_rig();
  bench.spheres.lights.clear();
  bench.rig.camera.camera_from_rig = Eigen::Isometry3d(Eigen::Translation3d(-offset));
  bench.rig.light_positioner.pivot_in_rig = offset + Eigen::Vector3d(0.0, 0.0, 1.0);
  bench.rig.light_positioner.radius_m = 1.0;
  const double places[][2] = {{-60.0, -30.0}, {-100.0, -10.0}, {-30.0, -50.0}, {-140.0, -20.0}};
  for (const auto& [azimuth_deg, elevation_deg] : places) {
    PlannedView& planned = bench.plan.views.emplace_back();
    planned.name = "view" + std::to_string(bench.views.size());
    FrameRecord& shot = bench.views.emplace_back().spheres.point;
    shot.light_azimuth_deg = azimuth_deg;
    shot.light_elevation_deg = elevation_deg;
    bench.spheres.lights.push_back(bench.rig.camera.camera_from_rig *
                                   bench.rig.light_positioner.nominal_position_in_rig(azimuth_deg, elevation_deg) +
                                   Eigen::Vector3d(0.004, -0.003, 0.002));
  }
  return bench;
}

SessionLights lights_of(const LightBench& bench, std::uint64_t seed) {
  const LightSolution solution = solved_lights(bench.spheres, noisy_highlights(bench.spheres, kSigma_px, seed));
  return align_lights(solution, bench.views, bench.plan, bench.rig, bench.rig.camera.camera_from_rig);
}

}  // namespace lumitexel
