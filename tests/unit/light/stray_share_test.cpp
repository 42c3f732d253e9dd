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
  const Eigen::Array3d truth =
      strength * kStray / kLamp * (irradiance(in_rig, stray_in_rig) / irradiance(in_rig, found.true_in_rig[1]));
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_TRUE(share[c]) << c;
    const double of = truth[static_cast<Eigen::Index>(c)];
    // Two lights' fluxes, each good to a per cent or two: were a distance, a cosine or a width forgotten, it would be tens.
    EXPECT_NEAR(share[c]->value / of, 1.0, 0.06) << c;
    EXPECT_LT(std::abs(share[c]->value - of), 3.0 * share[c]->sigma) << c;
    EXPECT_LT(share[c]->sigma, 0.06 * of) << c;
  }
}

TEST(StrayShare, OfALampAsNearAsTheRigs) { expect_share({1.0, -0.9, 0.6}, 1.0); }

// The cores of its highlights are saturated.
TEST(StrayShare, OfABrighterLampFromTheSide) { expect_share({0.4, 1.2, 0.3}, 4.0); }

// Of a mosaic whose highlights were binned the green alone is known; green's share in the place of red's and blue's would be wrong by half.
TEST(StrayShare, OfAColouredLampOnBinnedPicturesIsKnownInGreenAlone) {
  const PicturedLights found =
      photograph_spheres("simulation.second_lamp_w_per_sr = [16.0, 9.0, 5.0]\nsimulation.second_lamp_in_rig_m = [1.0, -0.9, 0.6]\n", 1, 2);
  ASSERT_EQ(found.strays.size(), 1u);
  const LightSolution& lights = found.lights.spheres;
  const ShareOfChannels ratio = stray_ratio(found.strays[0], found.strays[0].position, lights.line, lamp_strengths(found.seen, lights));
  EXPECT_FALSE(ratio[0]);
  EXPECT_FALSE(ratio[2]);
  ASSERT_TRUE(ratio[1]);
  EXPECT_LT(std::abs(ratio[1]->value - 0.9), 3.0 * ratio[1]->sigma + 0.05 * 0.9);  // the place is off by a per cent or two
}

// Four spheres along x, half a metre before the camera; lamp and stray at one place, a metre before them, so that ratios are fluxes'.
class ExactSpheres {
 public:
  ExactSpheres() : at_(0.3, -0.4, -0.2) {
    line_.count = 4;
    line_.spacing_m = 0.05;
    line_.radius_m = 0.02;
    line_.first_centre = {-0.075, 0.0, 1.0};
    line_.direction = Eigen::Vector3d::UnitX();
  }
  ShareOfChannels ratio(const std::vector<HighlightPixel>& stray, const Strength& lamp) const {
    StrayLight light;
    light.position = at_;
    light.highlights = stray;
    std::vector<Strength> lamps;
    for (int k = 0; k < line_.count; ++k) {
      Strength strength = lamp;
      const double square = (at_ - mirror_point(line_.sphere(k), Eigen::Vector3d::Zero(), at_)).squaredNorm();
      for (auto& value : strength) {
        if (value) *value *= square;
      }
      lamps.push_back(strength);
    }
    return stray_ratio(light, at_, line_, lamps);
  }

 private:
  SphereLine line_;
  Eigen::Vector3d at_;
};

HighlightPixel with_flux(int sphere, double red, double green, double blue) {
  HighlightPixel highlight;
  highlight.sphere = sphere;
  highlight.flux = {red, green, blue};
  return highlight;
}

TEST(StrayRatio, IsKnownChannelByChannel) {
  std::vector<HighlightPixel> stray;
  for (int k = 0; k < 4; ++k) stray.push_back(with_flux(k, k % 2 == 0 ? 1e-3 : -1e-3, 1.0, 0.5));
  const ShareOfChannels ratio = ExactSpheres().ratio(stray, {2.0, 2.0, std::nullopt});
  EXPECT_FALSE(ratio[0]);  // nothing but noise
  EXPECT_FALSE(ratio[2]);  // the lamp's is not known
  ASSERT_TRUE(ratio[1]);
  EXPECT_NEAR(ratio[1]->value, 0.5, 1e-9);
  EXPECT_NEAR(ratio[1]->sigma, 0.02 * 0.5, 1e-9);
}

TEST(StrayRatio, OfManyHighlightsIsAsSureAsItsSpheresAreMany) {
  std::vector<HighlightPixel> once, often;
  const double factor[] = {0.9, 0.97, 1.03, 1.1};
  for (int k = 0; k < 4; ++k) {
    for (int view = 0; view < 9; ++view) often.push_back(with_flux(k, factor[k], factor[k], factor[k]));
    once.push_back(often.back());
  }
  const ShareOfChannels few = ExactSpheres().ratio(once, {1.0, 1.0, 1.0}), many = ExactSpheres().ratio(often, {1.0, 1.0, 1.0});
  ASSERT_TRUE(few[1] && many[1]);
  EXPECT_EQ(few[1]->sigma, many[1]->sigma);
  EXPECT_GT(many[1]->sigma, 1.2 * 0.085 / 2.0);  // the four's standard deviation, over two, and more for they are but four
  EXPECT_FALSE(ExactSpheres().ratio({often.begin(), often.begin() + 9}, {1.0, 1.0, 1.0})[1]);  // one sphere tells no scatter
}

}  // namespace
}  // namespace lumitexel
