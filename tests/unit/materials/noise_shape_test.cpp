#include "processing/brdf/choose_noise_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "processing/brdf/experiment/five_materials.h"
#include "processing/brdf/misfit.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

const Brdf kMatte = [] {
  Brdf brdf;
  brdf.channels = 1;
  brdf.diffuse[0] = 0.2;
  return brdf;
}();

Observation measured(double reflectance) {
  Observation sample;
  sample.geometry = lobe_geometry(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.3, 0.0, 0.9).normalized(), Eigen::Vector3d(-0.2, 0.1, 0.9).normalized());
  sample.reflectance[0] = static_cast<float>(reflectance);
  return sample;
}

ErrorModel two_normals(double share) {
  ErrorModel error(0.05, 1e-9);
  error.freedom = ErrorModel::kGaussian;
  error.outlier_share = share;
  error.outlier_scale = 10.0;
  return error;
}

double one(const ShapedMisfit& shaped, const Observation& sample) { return shaped.of(std::span(&sample, 1)); }

// The density over all reflectances is one and its variance that of the scale, by 40,000 steps over +- 60 of it. Measurements are floats, and one
// in 100,000 is always an outlier: a thousandth, of the variance two.
TEST(NoiseShape, IsADensityOfTheScalesVariance) {
  const double mean = predicted_reflectance(kMatte, measured(0.2).geometry)[0], scale = 0.05 * mean;
  for (const double share : {0.0, 0.02}) {
    const ErrorModel error = two_normals(share);
    const double variance = 1.0 - share + share * 100.0;
    for (const double power : {2.0, 3.0, 8.0, 64.0}) {
      const ShapedMisfit shaped(kMatte, error, {power, 1.0});
      double whole = 0.0, second = 0.0;
      constexpr int kSteps = 40'000;
      const double step = 120.0 * scale / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        const double away = -60.0 * scale + (i + 0.5) * step;
        const double density = std::exp(-0.5 * one(shaped, measured(mean + away))) / std::sqrt(2.0 * 3.14159265358979);
        whole += density * step;
        second += density * step * away * away / (scale * scale);
      }
      EXPECT_NEAR(whole, 1.0, 1e-3) << power << ' ' << share;
      EXPECT_NEAR(second, variance, 2e-3 * variance) << power << ' ' << share;
    }
  }
}

// At p = 2 it is what the error model says.
TEST(NoiseShape, OfPowerTwoIsTheErrorModelItself) {
  const ErrorModel error = two_normals(0.02);
  const ShapedMisfit shaped(kMatte, error, {});
  for (const double reflectance : {0.0, 0.1, 0.19, 0.2, 0.3, 5.0}) {
    const Observation sample = measured(reflectance);
    EXPECT_NEAR(one(shaped, sample), misfit(kMatte, std::span(&sample, 1), error), 1e-9 * (1.0 + std::abs(one(shaped, sample)))) << reflectance;
  }
}

// Far out, where |z|^64 is not a number any more, it is the wide normal's.
TEST(NoiseShape, IsFiniteHoweverFarASampleLies) {
  const ShapedMisfit shaped(kMatte, two_normals(0.0), {64.0, 1.0});
  double before = 0.0;
  for (const double reflectance : {1.0, 1e3, 1e9, 1e18}) {
    const double value = one(shaped, measured(reflectance));
    EXPECT_TRUE(std::isfinite(value)) << reflectance;
    EXPECT_GT(value, before) << reflectance;
    before = value;
  }
}

NoiseShape chosen(const FiveMaterialsOptions& options, unsigned seed) {
  const FiveMaterials world = make_five_materials(seed, options);
  ErrorModel error(world.relative_sigma, 1e-9);
  error.freedom = ErrorModel::kGaussian;
  if (options.outliers > 0.0) {
    error.outlier_share = options.outliers;
    error.outlier_scale = 1.0 / world.relative_sigma;
  }
  Mixture truth;
  LumitexelList all;
  for (std::size_t i = 0; i < world.label.size(); ++i) all.push_back(i);
  for (const Brdf& brdf : world.truth) {
    truth.materials.push_back({brdf, error});
    truth.share.push_back(0.2);
  }
  return choose_noise_shape(truth, world.observations, all, responsibilities(truth, world.observations, all));
}

// 100 seeds of 120 lumitexels with 11 samples each, 5 % noise.
TEST(NoiseShape, OnlyNoiseThatEndsAbruptlyIsSaidToInAtLeast95Of100) {
  FiveMaterialsOptions normal, uniform, outliers;
  normal.lumitexels = uniform.lumitexels = outliers.lumitexels = 120;
  normal.gaussian = true;
  outliers.outliers = 0.02;
  int no = 0, yes = 0, beside_outliers = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    no += chosen(normal, seed).normal();
    yes += chosen(uniform, seed).power >= 8.0;
    beside_outliers += chosen(outliers, seed).power >= 8.0;
  }
  EXPECT_GE(no, 95);
  EXPECT_GE(yes, 95);
  EXPECT_GE(beside_outliers, 95);
}

TEST(NoiseShape, HeavyTailsHaveNoEdge) {
  FiveMaterialsOptions options;
  options.lumitexels = 300;
  const FiveMaterials world = make_five_materials(1, options);
  ErrorModel error(world.relative_sigma, 1e-9);
  error.freedom = 10.0;
  Mixture truth{{{world.truth[0], error}}, {1.0}, {}};
  const LumitexelList all = with_samples(world.observations);
  EXPECT_TRUE(choose_noise_shape(truth, world.observations, all, responsibilities(truth, world.observations, all)).normal());
}

}  // namespace
}  // namespace lumitexel
