#include "processing/brdf/fit_material.h"

#include <gtest/gtest.h>

#include <cmath>

#include "processing/brdf/lobe_starts.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

std::vector<FitSample> all_samples(const Observations& observations) {
  std::vector<FitSample> list;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    for (const Observation& sample : observations.of(i)) list.push_back({&sample, 1.0, static_cast<std::uint32_t>(i)});
  }
  return list;
}

// The error model is known, and one lobe is there.
MaterialFitOptions with_error(double relative, double floor) {
  MaterialFitOptions options;
  options.error = ErrorModel(relative, floor);
  options.estimate_error = false;
  return options;
}

double log_exponent_error(const Brdf& fit, const Brdf& truth) {
  return fit.lobes[0][0].log_shape - truth.lobes[0][0].log_shape;
}

TEST(FitMaterial, FindsTheTruthFromNoiselessSamples) {
  constexpr double kFloatRounding = 1e-5;  // samples are stored as float
  for (const double exponent : {5.0, 40.0, 400.0}) {
    for (const double phi : {0.70, 0.7853981633974483, 0.81}) {  // more, and N = 400 peaks beyond the samples
      std::mt19937 random(3);
      const Brdf truth = one_lobe({0.1, 0.06, 0.2}, {1.5, 0.8, 0.4}, phi, exponent);
      Observations observations;
      add_lumitexels(observations, truth, 400, 8, 0.0, random);
      const BrdfFit fit = fit_material(all_samples(observations), 3, nullptr, with_error(0.3, 1e-3)).fit;
      EXPECT_TRUE(fit.converged);
      EXPECT_FALSE(fit.rank_deficient);
      EXPECT_NEAR(log_exponent_error(fit.brdf, truth), 0.0, 1e2 * kFloatRounding) << exponent << ' ' << phi;
      EXPECT_NEAR(fit.brdf.lobes[0][0].aim, phi, 1e2 * kFloatRounding) << exponent << ' ' << phi;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(fit.brdf.diffuse[c], truth.diffuse[c], kFloatRounding) << exponent << ' ' << phi;
      }
    }
  }
}

TEST(FitMaterial, CovarianceTellsTheSpreadOverNoise) {
  // 60 seeds: the standard deviation itself is known to 1/sqrt(2*60) = 9 %; three of those either way.
  constexpr int kSeeds = 60;
  constexpr double kAllowed = 0.28;
  const Brdf truth = one_lobe({0.1, 0.06, 0.2}, {1.5, 0.8, 0.4}, 0.7853981633974483, 30.0);
  const MaterialFitOptions options = with_error(0.05, 1e-4);
  double squares = 0.0, stated = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 random(static_cast<unsigned>(100 + seed));
    Observations observations;
    add_lumitexels(observations, truth, 60, 8, 0.05, random);
    const BrdfFit fit = fit_material(all_samples(observations), 3, nullptr, options).fit;
    squares += std::pow(log_exponent_error(fit.brdf, truth), 2);
    const int row = parameters_of(fit.brdf, {}).log_shape(0, 0);
    stated += fit.covariance(row, row);
  }
  EXPECT_NEAR(std::sqrt(squares / stated), 1.0, kAllowed);
}

TEST(FitMaterial, SeparateShapesFollowEachChannel) {
  std::mt19937 random(5);
  Brdf truth = one_lobe({0.1, 0.06, 0.2}, {1.5, 0.8, 0.9}, 0.7853981633974483, 20.0);
  truth.lobes[0][2].log_shape = std::log(80.0);
  Observations observations;
  add_lumitexels(observations, truth, 400, 8, 0.0, random);
  MaterialFitOptions options = with_error(0.3, 1e-3);
  options.shared_shape = false;
  const BrdfFit fit = fit_material(all_samples(observations), 3, nullptr, options).fit;
  EXPECT_NEAR(std::exp(fit.brdf.lobes[0][0].log_shape), 20.0, 0.02);
  EXPECT_NEAR(std::exp(fit.brdf.lobes[0][2].log_shape), 80.0, 0.08);
}

TEST(FitMaterial, AMatteSurfaceGetsNoLobeAndAFaintlyGlossyOneDoes) {
  const MaterialFitOptions options = with_error(0.05, 1e-3);
  int matte_right = 0, glossy_right = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    Observations matte, glossy;
    add_lumitexels(matte, one_lobe({0.10, 0.06, 0.2}, {1e-9, 1e-9, 1e-9}, 0.78, 20.0), 100, 6, 0.05, random);
    add_lumitexels(glossy, one_lobe({0.10, 0.06, 0.2}, {0.05, 0.05, 0.05}, 0.78, 20.0), 100, 6, 0.05, random);
    matte_right += fit_material(all_samples(matte), 3, nullptr, options).model.brdf.lobes.empty();
    glossy_right += !fit_material(all_samples(glossy), 3, nullptr, options).model.brdf.lobes.empty();
  }
  EXPECT_GE(matte_right, 95);
  EXPECT_GE(glossy_right, 95);
}

TEST(FitMaterial, NeverReflectsMuchMoreThanItReceives) {
  // Samples that rise steeply towards glancing light invite a lobe that explodes where nobody looked.
  std::mt19937 random(11);
  Observations observations;
  add_lumitexels(observations, one_lobe({0.05, 0.05, 0.05}, {0.5, 0.5, 0.5}, 0.78, 20.0), 100, 6, 0.0, random);
  for (Observation& sample : observations.samples) {
    const double boost = std::pow(1.2 - sample.geometry.cos_i, 6.0) * 20.0;
    for (float& r : sample.reflectance) r *= static_cast<float>(1.0 + boost);
  }
  const BrdfFit fit = fit_material(all_samples(observations), 3, nullptr, with_error(0.3, 1e-3)).fit;
  const Lobe& lobe = fit.brdf.lobes[0][0];
  EXPECT_LE(2.0 * M_PI * std::exp(lobe.log_strength) / (std::exp(lobe.log_shape) + 2.0), 4.0 + 1e-9);
}

TEST(FitMaterial, SaysWhatTheSamplesCannotTell) {
  EXPECT_TRUE(fit_material({}, 3, nullptr, with_error(0.3, 1e-3)).fit.rank_deficient);

  // One geometry only: kd alone explains it, and with a lobe, if there must be one, the two cannot be told apart.
  std::mt19937 random(7);
  Observations observations;
  add_lumitexels(observations, one_lobe({0.1, 0.1, 0.1}, {1, 1, 1}, 0.78, 20.0), 1, 1, 0.0, random);
  observations.samples.resize(50, observations.samples[0]);
  observations.first.back() = 50;
  MaterialFitOptions with_lobe = with_error(0.3, 1e-3);
  EXPECT_TRUE(fit_material(all_samples(observations), 3, nullptr, with_lobe).model.brdf.lobes.empty());
  with_lobe.choose_lobes = false;
  const BrdfFit fit = fit_material(all_samples(observations), 3, nullptr, with_lobe).fit;
  EXPECT_TRUE(fit.rank_deficient);
  EXPECT_TRUE(fit.covariance.allFinite());
  EXPECT_TRUE(std::isfinite(fit.misfit));
}

TEST(FitMaterial, ABlackSurfaceGivesABlackBrdfWithoutNaN) {
  std::mt19937 random(9);
  Observations observations;
  add_lumitexels(observations, one_lobe({0, 0, 0}, {1e-12, 1e-12, 1e-12}, 0.78, 20.0), 50, 6, 0.0, random);
  const BrdfFit fit = fit_material(all_samples(observations), 3, nullptr, with_error(0.3, 1e-3)).fit;
  EXPECT_TRUE(fit.covariance.allFinite());
  for (const Observation& sample : observations.samples) {
    EXPECT_NEAR(predicted_reflectance(fit.brdf, 0, sample.geometry), 0.0, 1e-3);  // the error model's floor
  }
}

}  // namespace
}  // namespace lumitexel
