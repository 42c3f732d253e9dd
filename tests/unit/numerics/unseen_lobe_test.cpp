// Lobes that no sample sees: where they stand the cost is flat, and Gauss-Newton's step has no bound.
#include <gtest/gtest.h>

#include <cmath>

#include "processing/brdf/fit_material.h"
#include "processing/brdf/numerics/synthetic_observations.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kGrazingAim = 0.9353981633974483;  // the forward range's end: the peak is where the light comes in flat
// Of the cost at which the iteration ends, 1e-7, the root, over the samples' spread.
constexpr double kSettled = 1e-3;
constexpr double kRounding = 1e-12;

Observations matte_samples() {
  std::mt19937 random(5);
  Observations observations;
  add_lumitexels(observations, one_lobe({0.1, 0.06, 0.2}, {1e-9, 1e-9, 1e-9}, kMirrorAim, 10.0), 100, 6, 0.1, random);
  return observations;
}

BrdfFitOptions as_weighted_at_start() {
  BrdfFitOptions options;
  options.error = ErrorModel(0.3, 1e-3);
  options.robust = false;
  return options;
}

TEST(UnseenLobe, DoesNotHoldUpTheRest) {
  const Observations observations = matte_samples();
  // So sharp and so far off that every sample loses it in its rounding, though it is nowhere nothing at all.
  const Brdf start = one_lobe({0.02, 0.3, 0.07}, {200.0, 10.0, 3.0}, kGrazingAim, 1144.0);
  double most = 0.0;
  for (const FitSample& sample : all_samples(observations)) {
    most = std::max(most, lobe_family(BrdfFamily::Lafortune).terms(start.lobes[0][0].log_shape, kGrazingAim, sample.observation->geometry).gain);
  }
  ASSERT_GT(most, 0.0);
  ASSERT_LT(most, 1e-16);
  const BrdfFit fit = fit_brdf(start, all_samples(observations), as_weighted_at_start());
  Brdf matte = start;
  matte.lobes.clear();
  const BrdfFit alone = fit_brdf(matte, all_samples(observations), as_weighted_at_start());
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(fit.brdf.diffuse[c], alone.brdf.diffuse[c], kSettled * alone.brdf.diffuse[c]) << c;
  EXPECT_TRUE(fit.rank_deficient);
  EXPECT_TRUE(fit.covariance.allFinite());
  EXPECT_EQ(fit.brdf.lobes[0][0].log_shape, start.lobes[0][0].log_shape);  // what nothing speaks about stays
}

TEST(UnseenLobe, NoStepLeapsOverTheSamples) {
  const Brdf start = one_lobe({8.0, 8.0, 8.0}, {0.1, 0.1, 0.1}, 0.0, 10.0);  // in the middle of what may be
  BrdfFitOptions options;
  options.bounds = {widest_bounds(BrdfFamily::Lafortune)};
  for (const bool shared : {true, false}) {
    options.shared_shape = shared;
    const BrdfParameters layout = parameters_of(start, options);
    const Eigen::VectorXd values = layout.from(start);
    for (const double step : {4.0, -4.0, 0.01}) {
      const Eigen::VectorXd moved = layout.stepped(values, Eigen::VectorXd::Constant(layout.size(), step)) - values;
      const auto at_most = [&](double longest) { return std::copysign(std::min(std::abs(step), longest), step); };
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(moved[layout.diffuse(c)], step, kRounding);  // the model is linear in it
        EXPECT_NEAR(moved[layout.log_strength(0, c)], at_most(std::log(10.0)), kRounding);
        EXPECT_NEAR(moved[layout.log_shape(0, c)], at_most(std::log(3.0)), kRounding);
        EXPECT_NEAR(moved[layout.aim(0, c)], at_most(0.2), kRounding);
      }
    }
  }
}

// The scale of the reflectances has no say in what counts as seen.
TEST(UnseenLobe, FaintLobesOfFaintMaterialsAreSeen) {
  for (const double scale : {1e-5, 1e-2, 10.0}) {
    std::mt19937 random(5);
    Observations observations;
    const auto scaled = [&](double value) { return std::array<double, 3>{value * scale, value * scale, value * scale}; };
    const Brdf truth = one_lobe(scaled(0.1), scaled(1.5), kMirrorAim, 40.0);
    add_lumitexels(observations, truth, 200, 8, 0.02, random);
    BrdfFitOptions options = as_weighted_at_start();
    options.error = ErrorModel(0.3, 1e-3 * scale);
    options.bounds = {widest_bounds(BrdfFamily::Lafortune)};
    const BrdfFit fit = fit_brdf(one_lobe(scaled(0.2), scaled(0.3), 0.72, 15.0), all_samples(observations), options);
    EXPECT_NEAR(fit.brdf.lobes[0][0].log_shape, std::log(40.0), 0.05) << scale;
    EXPECT_FALSE(fit.rank_deficient) << scale;
  }
}

}  // namespace
}  // namespace lumitexel
