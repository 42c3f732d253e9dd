#include "processing/normals/texel_normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/normals/normal_patch.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

TEST(TangentFrame, IsSquareEverywhereAtThePolesToo) {
  std::mt19937 random(1);
  std::normal_distribution<double> draw;
  std::vector<Eigen::Vector3d> normals = {Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ(), {1e-9, 0.0, -1.0}, {0.0, -1e-200, -1.0}};
  for (int i = 0; i < 1000; ++i) normals.push_back(Eigen::Vector3d(draw(random), draw(random), draw(random)));
  for (const Eigen::Vector3d& any : normals) {
    const Eigen::Vector3d normal = any.normalized();
    const TangentFrame frame = tangent_frame(normal);
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix2d::Identity()).norm(), 1e-15 * 8);
    EXPECT_LT((frame.transpose() * normal).norm(), 1e-15 * 8);
  }
}

std::vector<DirectedSample> samples_about(const Eigen::Vector3d& normal, const NormalMaterial& material, const std::vector<float>& weight,
                                          double noise, std::mt19937& random) {
  std::normal_distribution<double> draw;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<DirectedSample> samples;
  while (samples.size() < 12) {
    DirectedSample sample;
    sample.wi = Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    sample.wo = samples.size() % 2 == 0 ? (2.0 * sample.wi.dot(normal) * normal - sample.wi + 0.02 * Eigen::Vector3d(draw(random), draw(random), 0)).normalized()
                                        : Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    if (sample.wi.dot(normal) < 0.2 || sample.wo.dot(normal) < 0.2) continue;
    const ChannelValues value = predicted_reflectance(material, weight, normal, sample, 3);
    for (std::size_t c = 0; c < 3; ++c) sample.observation.reflectance[c] = static_cast<float>(value[c] * (1.0 + noise * draw(random)));
    samples.push_back(sample);
  }
  return samples;
}

// Far off nothing is Gaussian, but near the optimum a Newton step by these equations has to arrive: quadratically, so that after three
// of them only the measurements' own rounding (they are floats) is left.
TEST(TexelNormal, StepsArriveAtTheTrueNormalFromNearbyWhateverTheLobe) {
  std::mt19937 random(2);
  for (const double exponent : {0.5, 10.0, 300.0, 1e4}) {
    const Brdf brdf = one_lobe({0.1, 0.08, 0.05}, {0.3, 0.3, 0.3}, 0.0, exponent);
    const NormalMaterial material({brdf}, 3, ErrorModel(0.05, 1e-3), TexelPrior{0.0, 0.0});
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector3d truth = Eigen::Vector3d(0.1 * trial, -1.0, 0.3 * trial).normalized();
      const std::vector<DirectedSample> samples = samples_about(truth, material, {1.0f}, 0.0, random);
      const TangentFrame about = tangent_frame(truth);
      Eigen::Vector3d normal = moved(truth, about, (0.02 / std::sqrt(exponent + 1.0)) * Eigen::Vector2d(0.6, -0.8));
      for (int step = 0; step < 5; ++step) {
        const TangentFrame frame = tangent_frame(normal);
        const NormalEquations equations = normal_equations(material, {1.0f}, normal, frame, samples, 3);
        normal = moved(normal, frame, equations.matrix.ldlt().solve(equations.right));
      }
      EXPECT_LT(angle_rad(normal, truth), 2e-6) << "exponent " << exponent << " trial " << trial;
    }
  }
}

// The cost's slope by central differences in the tangent plane is minus twice the right side, robust or not, off the truth, too: weights are
// held by a material that may not vary.
TEST(TexelNormal, RightSideIsTheCostsSlope) {
  std::mt19937 random(3);
  const Brdf brdf = one_lobe({0.1, 0.08, 0.05}, {0.3, 0.2, 0.3}, 0.0, 40.0);
  const Eigen::Vector3d truth = Eigen::Vector3d(0.2, 0.3, 0.9).normalized();
  for (const double freedom : {ErrorModel::kGaussian, 4.0}) {
    ErrorModel error(0.05, 1e-2);
    error.freedom = freedom;
    const NormalMaterial material({brdf}, 3, error, TexelPrior{0.0, 0.0});
    const std::vector<DirectedSample> samples = samples_about(truth, material, {1.0f}, 0.1, random);
    const std::vector<float> weight = {1.0f};
    const Eigen::Vector3d normal = moved(truth, tangent_frame(truth), {0.03, -0.05});
    const TangentFrame frame = tangent_frame(normal);
    constexpr double kHalfStep_rad = 1e-5;
    Eigen::Vector2d slope;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const auto cost = [&](double step) {
        const Eigen::Vector3d beside = moved(normal, frame, step * Eigen::Vector2d::Unit(axis));
        return normal_cost(material, {beside, weight}, {normal, weight}, samples, 3);
      };
      slope[axis] = (cost(kHalfStep_rad) - cost(-kHalfStep_rad)) / (2.0 * kHalfStep_rad);
    }
    const Eigen::Vector2d right = normal_equations(material, weight, normal, frame, samples, 3).right;
    EXPECT_LT((slope + 2.0 * right).norm(), 1e-3 * slope.norm()) << "freedom " << freedom;  // forward differences there, of 1e-6 rad
  }
}

// A lumitexel whose colour is off must not have it explained by its normal: with weights that may vary, the equations let them.
TEST(TexelNormal, WeightsTakeUpWhatIsNoSlope) {
  std::mt19937 random(4);
  const Brdf brdf = one_lobe({0.1, 0.08, 0.05}, {0.3, 0.3, 0.3}, 0.0, 30.0);
  const std::vector<Brdf> basis = {brdf, diffuse_brdf(0.1, 0.08, 0.05)};
  const NormalMaterial held(basis, 3, ErrorModel(0.05, 1e-3), TexelPrior{0.0, 0.0}), free(basis, 3, ErrorModel(0.05, 1e-3), TexelPrior{1.0, 1.0});
  const Eigen::Vector3d truth = Eigen::Vector3d(0.1, 0.2, 1.0).normalized();
  std::vector<DirectedSample> samples = samples_about(truth, held, {1.0f, 0.0f}, 0.0, random);
  for (DirectedSample& sample : samples) {
    for (float& value : sample.observation.reflectance) value *= 1.2f;
  }
  const auto found = [&](const NormalMaterial& material) {
    Eigen::Vector3d normal = truth;
    std::vector<float> weight = {1.0f, 0.0f};
    for (int step = 0; step < 8; ++step) {
      weight = best_weights(material, weight, normal, samples, 3);
      const TangentFrame frame = tangent_frame(normal);
      const NormalEquations equations = normal_equations(material, weight, normal, frame, samples, 3);
      normal = moved(normal, frame, equations.matrix.ldlt().solve(equations.right));
    }
    return angle_rad(normal, truth);
  };
  EXPECT_LT(found(free), 0.004);       // a quarter of a degree, from the prior about the material
  EXPECT_GT(found(held), 3.0 * found(free));
}

TEST(TexelNormal, PredictsNothingFromBelow) {
  const NormalMaterial material({diffuse_brdf(0.1, 0.1, 0.1)}, 3, ErrorModel(0.05, 1e-3), TexelPrior{0.0, 0.0});
  DirectedSample sample;
  sample.wi = Eigen::Vector3d(1.0, 0.0, -1e-12).normalized();
  sample.wo = Eigen::Vector3d::UnitZ();
  for (const double value : predicted_reflectance(material, {1.0f}, Eigen::Vector3d::UnitZ(), sample, 3)) EXPECT_EQ(value, 0.0);
}

}  // namespace
}  // namespace lumitexel
