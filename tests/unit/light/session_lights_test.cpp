// The lights of a session where its arm and spheres put them, wherever the rig's origin is.
#include "processing/calibration/session_lights.h"

#include <gtest/gtest.h>

#include "tests/unit/light/light_bench.h"

namespace lumitexel {
namespace {

// A kilometre costs ten bits of a double: 1e-13 m in a coordinate, which the arm's differences over 1e-5 m magnify to 1e-8 of
// their slope. A micrometre, a thousandth of what the lights are good to, is generous.
TEST(SessionLights, AreAsGoodAKilometreFromTheRigsOrigin) {
  const Eigen::Vector3d offset(600.0, -700.0, 400.0);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const SessionLights here = lights_of(bench_at(Eigen::Vector3d::Zero()), seed), there = lights_of(bench_at(offset), seed);
    for (std::size_t v = 0; v < here.in_rig.size(); ++v) {
      EXPECT_TRUE(there.summaries[v].from_spheres);
      EXPECT_LT((there.in_rig[v].position_in_rig - offset - here.in_rig[v].position_in_rig).norm(), 1e-6) << v;
      EXPECT_NEAR(there.summaries[v].sigma_m / here.summaries[v].sigma_m, 1.0, 1e-4) << v;
    }
  }
}

// Errors of lights, arm and line together over what is stated, per axis: mean square 1. 100 seeds of four lights that share
// most of their error: one sigma some 0.15. (A light that counts in the arm's prediction which it is merged with: 1.8.)
TEST(SessionLights, StateTheirErrors) {
  double sum = 0.0;
  constexpr int kSeeds = 100;
  const LightBench bench = bench_at(Eigen::Vector3d::Zero());
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SessionLights lights = lights_of(bench, seed);
    for (std::size_t v = 0; v < bench.views.size(); ++v) {
      const double error2 = (lights.in_rig[v].position_in_rig - bench.spheres.lights[v]).squaredNorm() / 3.0;
      sum += error2 / (lights.summaries[v].sigma_m * lights.summaries[v].sigma_m) / (4.0 * kSeeds);
    }
  }
  EXPECT_GT(sum, 0.5);
  EXPECT_LT(sum, 1.6);
}

}  // namespace
}  // namespace lumitexel
