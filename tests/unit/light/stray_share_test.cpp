// What a second lamp adds at the gray card, told from its highlights on rendered spheres.
#include "processing/calibration/light/stray_share.h"

#include <gtest/gtest.h>

#include "tests/unit/light/sphere_pictures.h"

namespace lumitexel {
namespace {

const Eigen::Array3d kStray(8.0, 9.0, 10.0);
const Eigen::Array3d kLamp(11.0, 10.0, 8.2);  // of the simulated bench

std::string second_lamp(const Eigen::Vector3d& at, double strength) {
  const auto list = [](const auto& v) {
    return "[" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]) + "]\n";
  };
  const Eigen::Array3d power = strength * kStray;
  return "simulation.second_lamp_w_per_sr = " + list(power) + "simulation.second_lamp_in_rig_m = " + list(at);
}

double irradiance(const LitPlace& place, const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_light = light - place.position;
  return to_light.dot(place.normal) / std::pow(to_light.norm(), 3);
}

// At the gray card under the second view's lamp.
void expect_share(const Eigen::Vector3d& stray_in_rig, double strength) {
  const PicturedLights found = photograph_spheres(second_lamp(stray_in_rig, strength));
  ASSERT_EQ(found.strays.size(), 1u);
  const LitPlace in_rig{found.rig.gray_card.centre_in_rig, found.rig.gray_card.normal_in_rig.normalized()};
  const Eigen::Isometry3d& camera_from_rig = found.rig.camera.camera_from_rig;
  const LitPlace place{camera_from_rig * in_rig.position, camera_from_rig.linear() * in_rig.normal};
  const LightSolution& lights = found.lights.spheres;
  const auto share =
      stray_share(found.strays[0], lights.line, lamp_strengths(found.seen, lights), place, lights.lights[1].position);
  ASSERT_TRUE(share);
  const Eigen::Array3d truth =
      strength * kStray / kLamp * (irradiance(in_rig, stray_in_rig) / irradiance(in_rig, found.true_in_rig[1]));
  for (std::size_t c = 0; c < 3; ++c) {
    const double of = truth[static_cast<Eigen::Index>(c)];
    // Two lights' fluxes, each good to a per cent or two: were a distance, a cosine or a width forgotten, it would be tens.
    EXPECT_NEAR(share->value[c] / of, 1.0, 0.06) << c;
    EXPECT_LT(std::abs(share->value[c] - of), 3.0 * share->sigma[c]) << c;
    EXPECT_LT(share->sigma[c], 0.06 * of) << c;
  }
}

TEST(StrayShare, OfALampAsNearAsTheRigs) { expect_share({1.0, -0.9, 0.6}, 1.0); }

// The cores of its highlights are saturated.
TEST(StrayShare, OfABrighterLampFromTheSide) { expect_share({0.4, 1.2, 0.3}, 4.0); }

}  // namespace
}  // namespace lumitexel
