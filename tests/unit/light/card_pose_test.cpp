#include "processing/calibration/light/card_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "processing/image/linear_sensor.h"
#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

// A card of 4 cm with a tag of 1.5 cm at each of its upper corners' outsides, seen from a metre with 2950 px.
struct Bench {
  CameraModel camera{1024, 768, 2950, 2950, 516.3, 379.8, -0.08, 0.15, 0.0004, -0.0003};
  GrayCardDescription card;
  std::vector<TagDescription> tags;
  Eigen::Isometry3d camera_from_rig = Eigen::Isometry3d::Identity();

  // Seen equally large from farther away: the lens grows with the distance.
  explicit Bench(double tilt_rad = 0.6, double distance_m = 1.0) {
    camera.focal_x_px = camera.focal_y_px = 2950.0 * distance_m;
    card.centre_in_rig = {0.02, -0.03, 0.01};
    card.normal_in_rig = Eigen::Vector3d(0.8, 0.1, 0.6).normalized();
    card.up_in_rig = Eigen::Vector3d::UnitZ();
    card.size_m = 0.04;
    const Eigen::Vector3d up = (card.up_in_rig - card.up_in_rig.dot(card.normal_in_rig) * card.normal_in_rig).normalized();
    const Eigen::Vector3d right = up.cross(card.normal_in_rig);
    for (const double side : {-1.0, 1.0}) {
      TagDescription tag;
      tag.id = side < 0 ? 7 : 8;
      tag.size_m = 0.015;
      tag.centre = card.centre_in_rig + side * 0.032 * right + 0.01 * up;
      tag.normal = card.normal_in_rig;
      tag.up = up;
      tags.push_back(tag);
    }
    Eigen::Matrix3d facing;  // the card seen straight on, then tilted
    facing << right.transpose(), -up.transpose(), -card.normal_in_rig.transpose();
    camera_from_rig.linear() = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(0.3, 1.0, 0.0).normalized()) * facing;
    camera_from_rig.translation() = Eigen::Vector3d(-0.05, 0.06, distance_m) - camera_from_rig.linear() * card.centre_in_rig;
  }
  std::vector<SeenTag> seen(double sigma_px, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, 1.0);
    std::vector<SeenTag> result;
    for (const TagDescription& tag : tags) {
      SeenTag s{tag.id, {}, std::max(sigma_px, 1e-3)};
      for (std::size_t k = 0; k < 4; ++k) {
        s.corners_px[k] = camera.project(camera_from_rig * tag.corners()[k]) + sigma_px * Eigen::Vector2d(noise(random), noise(random));
      }
      result.push_back(s);
    }
    return result;
  }
};

TEST(CardPose, IsExactFromExactCorners) {
  for (const double tilt : {0.3, 0.6, 1.0, 1.3}) {
    const Bench b(tilt);
    const CardPose pose = solve_card_pose(b.camera, b.tags, b.seen(0.0, 1));
    ASSERT_TRUE(pose.found);
    EXPECT_FALSE(pose.ambiguous);
    EXPECT_LT((pose.camera_from_card.matrix() - b.camera_from_rig.matrix()).norm(), 1e-6);
  }
}

TEST(CardPose, ErrorsAreWhatTheCovarianceSays) {
  const Bench b;
  double mahalanobis2 = 0.0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const CardPose pose = solve_card_pose(b.camera, b.tags, b.seen(0.05, seed));
    ASSERT_TRUE(pose.found);
    const Eigen::Isometry3d off = b.camera_from_rig * pose.camera_from_card.inverse();
    const Eigen::AngleAxisd turn(off.linear());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), off * pose.pivot_in_camera - pose.pivot_in_camera;
    const double scale2 = pose.sigma_scale * pose.sigma_scale;
    mahalanobis2 += error.dot((pose.covariance / scale2).inverse() * error) / kSeeds;
  }
  EXPECT_NEAR(mahalanobis2, 6.0, 1.0);  // a mean of 200 chi-squares of six: 0.25 one sigma
}

// Through a lens of 29,500 px from 10 m a plane's two poses differ by less than a tenth of a pixel.
TEST(CardPose, SaysWhenTheTiltCouldBeTheOtherWayRound) {
  int ambiguous = 0, wrong_unsaid = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Bench b(0.15, 10.0);
    const CardPose pose = solve_card_pose(b.camera, b.tags, b.seen(0.2, seed));
    ASSERT_TRUE(pose.found);
    ambiguous += pose.ambiguous;
    const double off = Eigen::AngleAxisd(b.camera_from_rig.linear().transpose() * pose.camera_from_card.linear()).angle();
    wrong_unsaid += off > 0.2 && !pose.ambiguous;
  }
  EXPECT_GE(ambiguous, 45);
  EXPECT_EQ(wrong_unsaid, 0);
}

TEST(CardPose, RefusesWhatIsNoCornerAndIgnoresOtherTags) {
  const Bench b;
  std::vector<SeenTag> seen = b.seen(0.0, 1);
  EXPECT_FALSE(solve_card_pose(b.camera, b.tags, {}).found);
  for (SeenTag& s : seen) s.id += 100;
  EXPECT_FALSE(solve_card_pose(b.camera, b.tags, seen).found);
  seen[1].id = seen[0].id;
  EXPECT_BAD_INPUT(solve_card_pose(b.camera, b.tags, seen), "card pose", "twice");
  seen = b.seen(0.0, 1);
  seen[0].corners_px[2].x() = std::nan("");
  EXPECT_BAD_INPUT(solve_card_pose(b.camera, b.tags, seen), "card pose", "finite");
}

MosaicRadiance picture_of_card(const Bench& b, const Eigen::Vector3d& light_in_camera, double noise, std::uint64_t seed) {
  MosaicRadiance m;
  m.width = b.camera.width_px;
  m.height = b.camera.height_px;
  m.value.assign(static_cast<std::size_t>(m.width) * static_cast<std::size_t>(m.height), 0.0f);
  m.variance.assign(m.value.size(), 1.0f);
  m.flags.assign(m.value.size(), 0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(1.0, noise);
  const Eigen::Vector3d centre = b.camera_from_rig * b.card.centre_in_rig, n = b.camera_from_rig.linear() * b.card.normal_in_rig;
  const Eigen::Vector2d middle = b.camera.project(centre);
  for (int y = static_cast<int>(middle.y()) - 70; y < static_cast<int>(middle.y()) + 70; ++y) {
    for (int x = static_cast<int>(middle.x()) - 70; x < static_cast<int>(middle.x()) + 70; ++x) {
      const Eigen::Vector3d d = b.camera.unproject({x + 0.5, y + 0.5});
      const Eigen::Vector3d to_light = light_in_camera - d * (centre.dot(n) / d.dot(n));
      m.value[m.index(x, y)] = static_cast<float>(b.card.albedo / M_PI * 1e6 * to_light.normalized().dot(n) /
                                                  to_light.squaredNorm() * normal(random));
    }
  }
  return m;
}

// Pixels, pose and light all wrong by what their sigmas say: the intensity's scatter over seeds is its sigma.
TEST(PosedCard, IntensityScattersAsItsSigmaSays) {
  const Bench b;
  const Eigen::Vector3d light(-0.5, -0.7, 0.3);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-6, 4e-6, 9e-6).asDiagonal();
  double z2 = 0.0;
  constexpr int kSeeds = 60;
  const MosaicRadiance picture = picture_of_card(b, light, 0.02, 1);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    std::mt19937_64 random(1000 + seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    const Eigen::Vector3d believed = light + Eigen::Vector3d(1e-3 * normal(random), 2e-3 * normal(random), 3e-3 * normal(random));
    const CardPose pose = solve_card_pose(b.camera, b.tags, b.seen(0.05, seed));
    const PosedCardIntensity card = measure_posed_card(picture, b.camera, pose, b.card, believed, covariance);
    z2 += std::pow((card.measured.intensity[0] / 1e6 - 1.0) / card.relative_sigma[0], 2) / kSeeds;
    EXPECT_LT(card.relative_sigma[0], 0.02);
  }
  EXPECT_GT(z2, 0.45);  // a mean of 60 squares: 0.18 one sigma
  EXPECT_LT(z2, 1.55);
}

}  // namespace
}  // namespace lumitexel
