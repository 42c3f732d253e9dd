// Microfacet parameters come back from samples: exactly without noise, within the stated covariance with it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

constexpr int kSeeds = 40;
constexpr double kNoise = 0.03;

Brdf truth_of(BrdfFamily family) { return known_brdf(family, {{0.08, 0.25}}); }

MaterialFitOptions one_lobe_of(BrdfFamily family) {
  MaterialFitOptions options;
  options.family = family;
  options.choose_lobes = false;
  return options;
}

class FamilyRecovery : public testing::TestWithParam<BrdfFamily> {};

TEST_P(FamilyRecovery, FindsTheTruthWithoutNoise) {
  const Brdf truth = truth_of(GetParam());
  const NoisySamples data = noisy_samples(truth, 150, 0.0, NoiseKind::Independent, 1);
  const MaterialFit fit = fit_material(data.samples, 3, nullptr, one_lobe_of(GetParam()));
  const BrdfParameters layout = parameters_of(truth, refit_options(fit.model, one_lobe_of(GetParam())));
  const Eigen::VectorXd difference = layout.from(fit.model.brdf) - layout.from(truth);
  // Samples are floats (6e-8), and the iteration ends when the cost falls by less than 1e-7 of itself.
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-4);
}

TEST_P(FamilyRecovery, ScattersAsItsCovarianceStates) {
  const Brdf truth = truth_of(GetParam());
  const MaterialFitOptions options = one_lobe_of(GetParam());
  Eigen::VectorXd sum, squares;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NoisySamples data = noisy_samples(truth, 80, kNoise, NoiseKind::Independent, seed);
    const MaterialFit fit = fit_material(data.samples, 3, nullptr, options);
    const BrdfParameters layout = parameters_of(truth, refit_options(fit.model, options));
    const Eigen::VectorXd z =
        (layout.from(fit.model.brdf) - layout.from(truth)).cwiseQuotient(fit.fit.covariance.diagonal().cwiseSqrt());
    ASSERT_TRUE(z.allFinite()) << "seed " << seed;
    if (seed == 1) sum = squares = Eigen::VectorXd::Zero(z.size());
    sum += z;
    squares += z.cwiseAbs2();
  }
  for (Eigen::Index p = 0; p < sum.size(); ++p) {
    // The mean of 40 standard normal numbers is off by 0.16: 3.5 of that for some ten parameters.
    EXPECT_LT(std::abs(sum[p]) / kSeeds, 0.55) << "parameter " << p;
    // Their mean square has a standard deviation of 0.22: as many.
    EXPECT_GT(squares[p] / kSeeds, 0.4) << "parameter " << p;
    EXPECT_LT(squares[p] / kSeeds, 1.8) << "parameter " << p;
  }
}

INSTANTIATE_TEST_SUITE_P(Microfacets, FamilyRecovery, testing::Values(BrdfFamily::Ggx, BrdfFamily::Ward),
                         [](const auto& family) { return std::string(to_string(family.param)); });

}  // namespace
}  // namespace lumitexel
