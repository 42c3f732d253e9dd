// How surely a material's numbers are known, as people read it.
#include "processing/brdf/brdf_sigma.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "processing/brdf/fit_material.h"
#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

constexpr int kSeeds = 200;
constexpr double kAllowed = 0.15;  // the standard deviation of 200 is known to 5 %; three of those either way

// Of what the report prints: root mean square error over root mean square of sigma.
struct Spread {
  double squares = 0, stated = 0;
  void add(double error, double sigma) {
    squares += error * error;
    stated += sigma * sigma;
  }
  double over_stated() const { return std::sqrt(squares / stated); }
};

struct Spreads {
  Spread diffuse, strength, shape, diffuse_as_independent;
};

Spreads spreads(const std::function<NoisySamples(const Brdf&, unsigned)>& photographed) {
  const Brdf truth = known_brdf(BrdfFamily::Lafortune, {KnownLobe{0.5, 30.0}});
  MaterialFitOptions options;
  options.choose_lobes = false;
  options.error = {0.05, 1e-4};
  Spreads all;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NoisySamples data = photographed(truth, seed);
    const MaterialFit fit = fit_material(data.samples, 3, nullptr, options);
    const BrdfSigma sigma = sigma_of(fit.model, data.samples, options);
    const Brdf& found = fit.model.brdf;
    all.diffuse.add(found.diffuse[1] - truth.diffuse[1], sigma.diffuse[1]);
    all.strength.add(found.lobes[0][1].log_strength - truth.lobes[0][1].log_strength, sigma.lobes[0][1].log_strength);
    all.shape.add(found.lobes[0][1].log_shape - truth.lobes[0][1].log_shape, sigma.lobes[0][1].log_shape);
    const BrdfSigma independent = sigma_of(fit.fit.covariance, parameters_of(found, refit_options(fit.model, options)));
    all.diffuse_as_independent.add(found.diffuse[1] - truth.diffuse[1], independent.diffuse[1]);
  }
  return all;
}

void expect_stated(const Spreads& all) {
  EXPECT_NEAR(all.diffuse.over_stated(), 1.0, kAllowed);
  EXPECT_NEAR(all.strength.over_stated(), 1.0, kAllowed);
  EXPECT_NEAR(all.shape.over_stated(), 1.0, kAllowed);
}

// Half of the variance is common to a lumitexel's samples: as if there were fewer. The sigma that people read knows it.
TEST(BrdfSigma, TellsTheSpreadWhereLumitexelsErrTogether) {
  const Spreads all = spreads([](const Brdf& truth, unsigned seed) { return noisy_samples(truth, 200, 0.05, NoiseKind::LumitexelTogether, seed); });
  expect_stated(all);
  EXPECT_GT(all.diffuse_as_independent.over_stated(), 1.0 + kAllowed) << "else it shows nothing";
}

// Student's t of three degrees of freedom, all channels of a sample at once: robust weights then fall with the residual.
TEST(BrdfSigma, TellsTheSpreadWhereErrorsHaveHeavyTails) {
  expect_stated(spreads([](const Brdf& truth, unsigned seed) {
    NoisySamples data = noisy_samples(truth, 200, 0.0, NoiseKind::Independent, seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::chi_squared_distribution<double> squares(3.0);
    for (Observation& sample : data.observations) {
      const double scale = 0.03 / std::sqrt(squares(random) / 3.0);
      for (float& r : sample.reflectance) r *= static_cast<float>(1.0 + scale * normal(random));
    }
    return data;
  }));
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
