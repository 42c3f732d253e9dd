#include "processing/calibration/light/arm_alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace lumitexel {
namespace {

constexpr double kDegree = M_PI / 180.0;

LightPositionerDescription nominal() {
  LightPositionerDescription arm;
  arm.pivot_in_rig = {0.01, -0.02, 0.03};
  arm.radius_m = 1.0;
  return arm;
}

// An arm mounted a little off: shifted, turned, longer, with an elevation zero of its own.
Eigen::Vector3d true_position(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = (elevation_deg + 0.6) * kDegree;
  const Eigen::Vector3d direction(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  return nominal().pivot_in_rig + Eigen::Vector3d(0.006, -0.004, 0.003) +
         1.005 * (Eigen::AngleAxisd(0.008, axis) * direction);
}

// Good across, poor along the line to the spheres, as sphere shots are.
Eigen::Matrix3d covariance_towards(const Eigen::Vector3d& position) {
  const Eigen::Vector3d along = position.normalized();
  return std::pow(0.0005, 2) * Eigen::Matrix3d::Identity() + std::pow(0.004, 2) * along * along.transpose();
}

std::vector<ArmSample> samples(int count, std::uint64_t seed, double scale = 1.0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> azimuth(-80, 80), elevation(5, 75);
  std::normal_distribution<double> normal;
  std::vector<ArmSample> result;
  for (int i = 0; i < count; ++i) {
    ArmSample s{azimuth(random), elevation(random), {}, {}};
    const Eigen::Vector3d truth = true_position(s.azimuth_deg, s.elevation_deg);
    s.covariance = covariance_towards(truth);
    const Eigen::Vector3d unit(normal(random), normal(random), normal(random));
    s.position_in_rig = truth + scale * Eigen::Vector3d(s.covariance.llt().matrixL() * unit);
    result.push_back(s);
  }
  return result;
}

TEST(ArmAlignment, PredictsAnUnseenPositionFromExactOnes) {
  const ArmAlignment arm(nominal(), samples(20, 1, 0.0));
  // The prior of 2 cm and 2 degrees pulls by (sigma / prior)^2 of a centimetre: well below a millimetre.
  EXPECT_LT((arm.predict(15.0, 40.0).position_in_rig - true_position(15.0, 40.0)).norm(), 2e-4);
  EXPECT_LT(arm.residual_m(), 2e-4);
}

TEST(ArmAlignment, ImprovesNoisyMeasurementsAndKnowsHowMuch) {
  double before = 0.0, after = 0.0, claimed = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const std::vector<ArmSample> measured = samples(20, seed);
    const ArmAlignment arm(nominal(), measured);
    for (const ArmSample& s : measured) {
      const Eigen::Vector3d truth = true_position(s.azimuth_deg, s.elevation_deg);
      const ArmPrediction combined = arm.combine(s);
      before += (s.position_in_rig - truth).squaredNorm();
      after += (combined.position_in_rig - truth).squaredNorm();
      claimed += combined.covariance.trace();
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(after), 0.6 * std::sqrt(before));  // 60 numbers fitted by 8: sqrt(8 / 60) = 0.37 at best
  EXPECT_GT(std::sqrt(claimed / after), 0.6);            // neither far too sure
  EXPECT_LT(std::sqrt(claimed / after), 1.7);            // nor far too modest
}

TEST(ArmAlignment, AMismeasuredViewIsToldApart) {
  std::vector<ArmSample> measured = samples(20, 3);
  measured[7].position_in_rig += Eigen::Vector3d(0.08, 0.05, -0.03);
  const ArmAlignment arm(nominal(), measured);
  for (std::size_t i = 0; i < measured.size(); ++i) EXPECT_EQ(arm.is_outlier(measured[i]), i == 7) << i;
  const ArmSample& bad = measured[7];
  EXPECT_LT((arm.predict(bad.azimuth_deg, bad.elevation_deg).position_in_rig -
             true_position(bad.azimuth_deg, bad.elevation_deg))
                .norm(),
            3e-3);
}

TEST(ArmAlignment, WithoutSamplesItIsTheNominalArm) {
  const ArmAlignment arm(nominal(), {});
  EXPECT_LT((arm.predict(30, 20).position_in_rig - nominal().nominal_position_in_rig(30, 20)).norm(), 1e-12);
  EXPECT_GT(std::sqrt(arm.predict(30, 20).covariance.trace() / 3.0), 0.02);
}

}  // namespace
}  // namespace lumitexel
