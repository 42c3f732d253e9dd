#include "processing/brdf/estimate_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kMirror = 0.7853981633974483;

std::vector<FitSample> all_samples(const Observations& observations) {
  std::vector<FitSample> list;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    for (const Observation& sample : observations.of(i)) list.push_back({&sample, 1.0, static_cast<std::uint32_t>(i)});
  }
  return list;
}

struct Noise {
  double relative = 0.05, common = 0, of_lumitexel = 0, outliers = 0;  // common: share of the variance that all channels have alike
};

Observations noisy(const Brdf& truth, const Noise& noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Observations observations;
  add_lumitexels(observations, truth, 400, 6, 0.0, random);
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    const double of_all = normal(random);
    for (std::size_t s = observations.first[i]; s < observations.first[i + 1]; ++s) {
      const double shared = normal(random), wrong = unit(random) < noise.outliers ? 3.0 * unit(random) : 1.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double error = std::sqrt(noise.of_lumitexel) * of_all +
                             std::sqrt(1.0 - noise.of_lumitexel) * (std::sqrt(noise.common) * shared + std::sqrt(1.0 - noise.common) * normal(random));
        observations.samples[s].reflectance[c] *= static_cast<float>(wrong * (1.0 + noise.relative * error));
      }
    }
  }
  return observations;
}

const Brdf kTruth = one_lobe({0.10, 0.06, 0.2}, {0.8, 0.8, 0.8}, kMirror, 25.0);

// 400 x 6 samples x 3 channels: a scale is known to 1 / sqrt(2 * 7200) = 1.2 %, less where channels go together; four of those.
TEST(EstimateError, FindsScaleAndThatChannelsGoTogether) {
  for (const double common : {0.0, 0.8}) {
    const Observations observations = noisy(kTruth, {0.05, common, 0.0, 0.0}, 3);
    const ErrorModel found = estimate_error_model(kTruth, all_samples(observations), ErrorModel(0.3, 1e-3));
    EXPECT_NEAR(found.relative, 0.05, 0.05 * (common > 0.0 ? 0.08 : 0.05)) << common;
    EXPECT_GE(found.freedom, 10.0) << common;
    const Eigen::MatrixXd inverse = found.whitening();
    const Eigen::MatrixXd correlation = (inverse.transpose() * inverse).inverse();
    EXPECT_NEAR(correlation(0, 1), common, 0.05) << common;
  }
}

// 3 % of 2,400 samples are outliers, 72 on average, of which one in nine is within three deviations of the truth: 64 +- 8 show.
TEST(EstimateError, OutliersBecomeAWideNormalAndLeaveTheScale) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Observations observations = noisy(kTruth, {0.05, 0.0, 0.0, 0.03}, seed);
    const ErrorModel found = estimate_error_model(kTruth, all_samples(observations), ErrorModel(0.3, 1e-3));
    EXPECT_NEAR(found.outlier_share, 0.027, 0.012) << seed;
    EXPECT_GT(found.outlier_scale, 10.0) << seed;  // 1.0 / 0.05 is 20
    EXPECT_NEAR(found.relative, 0.05, 0.05 * 0.06) << seed;
  }
}

TEST(EstimateError, NoWideNormalWhereNoneIs) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const ErrorModel found = estimate_error_model(kTruth, all_samples(noisy(kTruth, {}, seed)), ErrorModel(0.3, 1e-3));
    EXPECT_EQ(found.outlier_share, 0.0) << seed;
  }
}

// Errors of Student's t with three degrees: tails of every size, which two normal distributions do not have.
TEST(EstimateError, StudentsTailsStayStudents) {
  int students = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::chi_squared_distribution<double> chi_squared(3.0);
    Observations observations = noisy(kTruth, {0.0, 0.0, 0.0, 0.0}, seed);
    for (Observation& sample : observations.samples) {
      const double stretch = std::sqrt(3.0 / chi_squared(random));
      for (float& r : sample.reflectance) r *= static_cast<float>(1.0 + 0.03 * stretch * normal(random));
    }
    students += estimate_error_model(kTruth, all_samples(observations), ErrorModel(0.3, 1e-3)).outlier_share == 0.0;
  }
  EXPECT_GE(students, 9);
}

TEST(EstimateError, SamplesOfALumitexelThatErrAsOneCountLess) {
  const Observations apart = noisy(kTruth, {0.05, 0.0, 0.0, 0.0}, 5), together = noisy(kTruth, {0.05, 0.0, 0.6, 0.0}, 5);
  EXPECT_GT(estimate_error_model(kTruth, all_samples(apart), ErrorModel(0.3, 1e-3)).independence, 0.9);
  // 1 / (1 + 5 * 0.6) = 0.25, within what 400 lumitexels tell.
  EXPECT_NEAR(estimate_error_model(kTruth, all_samples(together), ErrorModel(0.3, 1e-3)).independence, 0.25, 0.05);
}

TEST(EstimateError, TooFewSamplesKeepWhatWasGiven) {
  Observations observations = noisy(kTruth, {}, 6);
  auto samples = all_samples(observations);
  samples.resize(20);
  EXPECT_EQ(estimate_error_model(kTruth, samples, ErrorModel(0.3, 1e-3)).relative, 0.3);
}

}  // namespace
}  // namespace lumitexel
