// The light step on rendered pictures: spheres cut by the picture's edge or hidden, lamps of some size, more than one lamp.
#include "tests/unit/light/sphere_pictures.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "drivers/error.h"
#include "processing/calibration/lens/rig_camera.h"
#include "processing/calibration/light/highlight_geometry.h"

namespace lumitexel {
namespace {

// Of a chi-square of three degrees of freedom: exceeded by one light of a thousand.
constexpr double kOneInThousand = 16.27;

void expect_within_sigma(const PicturedLights& found) {
  for (std::size_t v = 0; v < found.true_in_rig.size(); ++v) {
    ASSERT_TRUE(found.lights.spheres.lights[v].measured) << v;
    EXPECT_LT(found.squared_sigmas(v), kOneInThousand) << v << ": " << found.error_m(v) << " m";
  }
}

// config/rigs/simulated.toml has it, left to right in the picture.
SphereLine true_line(const RigDescription& rig) {
  const Eigen::Isometry3d& camera_from_rig = rig.camera.camera_from_rig;
  return {camera_from_rig * Eigen::Vector3d(-0.068, -0.125, 0.0835), camera_from_rig.linear() * Eigen::Vector3d(0.12, 0.99, 0.03).normalized(),
          rig.spheres.spacing_m, rig.spheres.radius_m, rig.spheres.count};
}

std::string spheres_from(double y_m) { return "simulation.first_sphere_in_rig_m = [-0.068, " + std::to_string(y_m) + ", 0.0835]\n"; }
// In front of the spheres as the camera sees them, the middle of the card at this height across the picture.
std::string card_before(double y_m, double size_m) {
  return "gray_card.centre_in_rig_m = [0.02, " + std::to_string(y_m) + ", 0.125]\ngray_card.size_m = " + std::to_string(size_m) + '\n';
}

// Eight lights over four sessions of other noise: the mean square of their errors in sigmas is three, a third of a
// degree either way; they share their line in twos, so one sigma is some 1.1.
TEST(SpherePictures, StateWhatTheirNoiseIsWorth) {
  double sum = 0.0;
  for (int seed = 1; seed <= 4; ++seed) {
    const PicturedLights found = photograph_spheres("simulation.seed = " + std::to_string(seed) + '\n');
    for (std::size_t v = 0; v < 2; ++v) sum += found.squared_sigmas(v) / 8.0;
  }
  EXPECT_GT(sum, 1.4);
  EXPECT_LT(sum, 5.5);
}

// The highlights are too large for what finds them at the camera's own scale.
TEST(SpherePictures, OnACameraOfTwiceThePixelsTheLightIsAsSure) {
  const PicturedLights found = photograph_spheres("", 2, 2);
  EXPECT_EQ(found.seen.rings.size(), 6u);
  expect_within_sigma(found);
  const PicturedLights coarser = photograph_spheres("");
  constexpr double kAsSure = 1.3;  // a quarter of the noise a block, but profile and lens count for more
  for (std::size_t v = 0; v < 2; ++v) {
    EXPECT_LT(found.lights.spheres.lights[v].covariance.trace(), kAsSure * kAsSure * coarser.lights.spheres.lights[v].covariance.trace());
    EXPECT_LT((found.seen.rings[0].pixel - 2.0 * coarser.seen.rings[0].pixel).norm(), 0.1);  // of 2048 pixels
  }
}

// The side of the ring that is nearer to a sphere lights it more: taken for an even ring, its highlights lie 0.005 px up and along the row
// from 0.0045 px left to 0.007 px right, which stretches the row and brings every light 1.4 mm too near.
TEST(SpherePictures, RingHighlightsAreWhereTheNearerSideOfTheRingDrawsThem) {
  const PicturedLights found = photograph_spheres("", 2, 2);
  const SphereLine line = true_line(found.rig);
  const CameraModel camera = camera_model_of(found.rig.camera);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double slope = 0.0, squares = 0.0;
  for (const HighlightPixel& ring : found.seen.rings) {
    const Eigen::Vector2d error = (ring.pixel - ring_highlight_pixel(camera, line.sphere(ring.sphere), found.rig.ring_flash.radius_m)) / 2.0;
    mean += error / 6.0;
    slope += error.x() * (ring.sphere - 2.5);
    squares += std::pow(ring.sphere - 2.5, 2);
  }
  // Of 1024: a coordinate scatters by 0.0025, the mean of six by 0.001, the slope by 0.0006 a sphere; three of each.
  EXPECT_LT(std::abs(mean.y()), 0.003);
  EXPECT_LT(std::abs(slope / squares), 0.0018);
}

TEST(SpherePictures, ASphereCutByThePicturesEdgeStillCounts) {
  const PicturedLights found = photograph_spheres(spheres_from(-0.176));  // its ring highlight two pixels from the edge
  EXPECT_EQ(found.seen.rings.size(), 6u);
  EXPECT_LT(found.seen.rings[0].pixel.x(), 8.0);
  EXPECT_LT(found.seen.points[1].size(), 6u);  // one light's highlight on it is outside
  expect_within_sigma(found);
}

TEST(SpherePictures, WithoutASphereThatIsOutOfThePictureTheOthersDo) {
  const PicturedLights found = photograph_spheres(spheres_from(-0.2));
  EXPECT_EQ(found.seen.rings.size(), 5u);
  expect_within_sigma(found);
}

TEST(SpherePictures, WithoutASphereThatIsHiddenTheOthersDo) {
  const PicturedLights found = photograph_spheres(card_before(0.02, 0.03));
  ASSERT_EQ(found.seen.rings.size(), 5u);
  EXPECT_EQ(found.seen.rings[3].sphere, 4);  // the fourth is the hidden one, and the line knows
  EXPECT_EQ(found.seen.points[0].size(), 5u);
  expect_within_sigma(found);
}

// The first is out of the picture and the third hidden.
TEST(SpherePictures, FourSpheresWithAGapDo) {
  const PicturedLights found = photograph_spheres(spheres_from(-0.2) + card_before(-0.085, 0.03));
  ASSERT_EQ(found.seen.rings.size(), 4u);
  EXPECT_EQ(found.seen.rings[1].sphere, 2);
  expect_within_sigma(found);
}

TEST(SpherePictures, AHighlightThatIsHalfHiddenIsFoundOut) {
  const PicturedLights found = photograph_spheres(card_before(0.02, 0.02));  // its edge runs through the fourth sphere's
  EXPECT_EQ(found.seen.points[0].size(), 6u);
  EXPECT_EQ(found.lights.spheres.lights[0].outliers, 1);
  expect_within_sigma(found);
}

TEST(SpherePictures, TooFewSpheresAreRefusedByName) {
  for (const double size_m : {0.17, 0.22}) {  // two of them seen, and one
    try {
      photograph_spheres(card_before(0.04, size_m));
      ADD_FAILURE() << size_m;
    } catch (const Error& refusal) {
      EXPECT_NE(std::string(refusal.what()).find("sphere shots: no view shows a straight row of 6"), std::string::npos) << refusal.what();
    }
  }
}

// 20 cm wide at a metre: its highlights are six pixels wide and flat. As a point only some of them can be fitted.
TEST(SpherePictures, ALampOfKnownSizeIsMeasuredAsOne) {
  const PicturedLights found = photograph_spheres("simulation.lamp_radius_m = 0.1\nlight_positioner.lamp_radius_m = 0.1\n");
  for (const auto& view : found.seen.points) EXPECT_EQ(view.size(), 6u);
  expect_within_sigma(found);
  EXPECT_LT(found.lights.spheres.residual_px, 0.015);
}

// Whose size nobody stated: told from its highlights, then used.
TEST(SpherePictures, ALampOfUnknownSizeTellsIt) {
  const PicturedLights found = photograph_spheres("simulation.lamp_radius_m = 0.05\n");
  ASSERT_TRUE(found.seen.size.resolved);
  EXPECT_LT(std::abs(found.seen.size.radius_m - 0.05), 3.0 * found.seen.size.sigma_m);
  EXPECT_LT(found.seen.size.sigma_m, 0.002);
  EXPECT_NEAR(found.seen.lamp.radius_m, found.seen.size.radius_m, found.seen.size.sigma_m);
  expect_within_sigma(found);
}

// The rig's file says 8 cm and is wrong: the highlights do not believe it.
TEST(SpherePictures, APointThatTheRigsFileCallsALampIsAPoint) {
  const PicturedLights found = photograph_spheres("light_positioner.lamp_radius_m = 0.08\n");
  EXPECT_TRUE(found.seen.size.measured);
  EXPECT_FALSE(found.seen.size.resolved);
  EXPECT_EQ(found.seen.lamp.radius_m, 0.0);
  expect_within_sigma(found);
}

const std::string kSecondLamp = "simulation.second_lamp_w_per_sr = [8.0, 9.0, 10.0]\nsimulation.second_lamp_in_rig_m = ";

TEST(SpherePictures, ASecondLampIsToldApartAndNamed) {
  const PicturedLights found = photograph_spheres(kSecondLamp + "[1.0, -0.9, 0.6]\n");
  expect_within_sigma(found);
  ASSERT_EQ(found.strays.size(), 1u);
  EXPECT_EQ(found.strays[0].views, (std::vector<std::size_t>{0, 1}));
  const Eigen::Vector3d error = found.strays[0].position - found.rig.camera.camera_from_rig * Eigen::Vector3d(1.0, -0.9, 0.6);
  EXPECT_LT(error.norm(), 0.05);
  // Both views share the line's error, which merging them takes for independent.
  EXPECT_LT(error.dot(found.strays[0].covariance.inverse() * error), 2.0 * kOneInThousand);
}

// The rig's lamp is a disc, the other one a point: with the disc's places where the lamp stands it would not fit, or wrongly.
TEST(SpherePictures, ASecondLampBesideALargeOneIsMeasuredAsAPoint) {
  const PicturedLights found =
      photograph_spheres("simulation.lamp_radius_m = 0.1\nlight_positioner.lamp_radius_m = 0.1\n" + kSecondLamp + "[1.0, -0.9, 0.6]\n");
  expect_within_sigma(found);
  ASSERT_EQ(found.strays.size(), 1u);
  EXPECT_EQ(found.strays[0].highlights.size(), 12u);
  const Eigen::Vector3d error = found.strays[0].position - found.rig.camera.camera_from_rig * Eigen::Vector3d(1.0, -0.9, 0.6);
  EXPECT_LT(error.dot(found.strays[0].covariance.inverse() * error), 2.0 * kOneInThousand);
  // Its own sigma is 3.6 mm. Fitted as discs the highlights were known to 0.04 to 0.08 px, and held three fifths of their flux.
  for (const HighlightPixel& seen : found.strays[0].highlights) EXPECT_LT(seen.sigma_px, 0.02);
}

// Ten degrees beside the lamp of the second view: skirts run together there, and the arm has to say where that light is.
TEST(SpherePictures, AViewWhoseLightHasACloseRivalIsLeftToTheArm) {
  const PicturedLights found = photograph_spheres(kSecondLamp + "[0.3, -0.9, 0.5]\n");
  EXPECT_TRUE(found.lights.spheres.lights[0].measured);
  EXPECT_LT(found.squared_sigmas(0), kOneInThousand);
  EXPECT_FALSE(found.lights.spheres.lights[1].measured);
  EXPECT_FALSE(found.lights.summaries[1].from_spheres);
}

}  // namespace
}  // namespace lumitexel
