// How surely a material's numbers are known, as people read it.
#include "processing/brdf/brdf_sigma.h"

#include <gtest/gtest.h>

#include <cmath>

#include "processing/brdf/fit_material.h"
#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

// Half of the variance is common to a lumitexel's samples: as if there were fewer. The sigma that people read knows it.
TEST(BrdfSigma, TellsTheSpreadWhereLumitexelsErrTogether) {
  constexpr int kSeeds = 200;
  constexpr double kAllowed = 0.15;  // the standard deviation of 200 is known to 5 %; three of those either way
  const Brdf truth = known_brdf(BrdfFamily::Lafortune, {KnownLobe{0.5, 30.0}});
  MaterialFitOptions options;
  options.error = {0.05, 1e-4};
  double squares = 0.0, stated = 0.0, as_independent = 0.0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NoisySamples data = noisy_samples(truth, 200, 0.05, NoiseKind::LumitexelTogether, seed);
    const MaterialFit fit = fit_material(data.samples, 3, nullptr, options);
    squares += std::pow(fit.model.brdf.diffuse[1] - truth.diffuse[1], 2);
    stated += std::pow(sigma_of(fit.model, data.samples, options).diffuse[1], 2);
    as_independent += std::pow(sigma_of(fit.fit.covariance, parameters_of(fit.model.brdf, refit_options(fit.model, options))).diffuse[1], 2);
  }
  EXPECT_NEAR(std::sqrt(squares / stated), 1.0, kAllowed);
  EXPECT_GT(std::sqrt(squares / as_independent), 1.0 + kAllowed) << "else it shows nothing";
}

TEST(BrdfSigma, IsLaidOutAsTheBrdfAndUnknownWhereNothingDeterminesIt) {
  const BrdfParameters parameters(BrdfFamily::Lafortune, 3, true, {usual_bounds(BrdfFamily::Lafortune)});
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(parameters.size(), parameters.size());
  covariance(parameters.diffuse(1), parameters.diffuse(1)) = 4.0;
  covariance(parameters.log_strength(0, 2), parameters.log_strength(0, 2)) = 9.0;
  covariance(parameters.log_shape(0, 0), parameters.log_shape(0, 0)) = 0.25;
  covariance(parameters.aim(0, 0), parameters.aim(0, 0)) = 0.0;  // at its bound
  const BrdfSigma sigma = sigma_of(covariance, parameters);
  EXPECT_EQ(sigma.diffuse, (std::array{1.0, 2.0, 1.0}));
  ASSERT_EQ(sigma.lobes.size(), 1u);
  EXPECT_EQ(sigma.lobes[0][2].log_strength, 3.0);
  EXPECT_EQ(sigma.lobes[0][1].log_shape, 0.5) << "shared";
  EXPECT_TRUE(std::isnan(sigma.lobes[0][1].aim));
}

}  // namespace
}  // namespace lumitexel
