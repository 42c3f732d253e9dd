#include "processing/brdf/principal_functions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kMirror = 0.7853981633974483, kInfinity = std::numeric_limits<double>::infinity();

// Texels that mix two BRDFs, of which the basis has neither exactly.
struct Mixtures {
  Observations observations;
  LumitexelList all;
  std::vector<Brdf> basis{one_lobe({0.08, 0.08, 0.08}, {0.5, 0.5, 0.5}, kMirror, 20.0), one_lobe({0.12, 0.12, 0.12}, {0.3, 0.3, 0.3}, kMirror, 30.0)};
  Mixtures() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const Brdf matte = one_lobe({0.2, 0.1, 0.05}, {1e-6, 1e-6, 1e-6}, kMirror, 20.0), shiny = one_lobe({0.02, 0.02, 0.02}, {1.0, 1.0, 1.0}, kMirror, 60.0);
    add_lumitexels(observations, matte, 200, 8, 0.0, random);
    for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
      const double share = unit(random);
      for (std::size_t s = observations.first[i]; s < observations.first[i + 1]; ++s) {
        Observation& sample = observations.samples[s];
        for (int c = 0; c < 3; ++c) {
          sample.reflectance[static_cast<std::size_t>(c)] =
              static_cast<float>(share * predicted_reflectance(matte, c, sample.geometry) + (1.0 - share) * predicted_reflectance(shiny, c, sample.geometry));
        }
      }
    }
    all.resize(200);
    std::iota(all.begin(), all.end(), std::size_t{0});
  }
};

PrincipalOptions options_with(const TexelPrior& prior) {
  PrincipalOptions options;
  options.functions = 2;
  options.max_iterations = 40;
  options.prior = prior;
  return options;
}

TEST(PrincipalFunctions, FindFunctionsWhoseMixturesExplainTheTexels) {
  const Mixtures world;
  const auto found = principal_functions(world.observations, world.all, world.basis, ErrorModel(0.05, 1e-3), options_with({kInfinity, kInfinity}));
  EXPECT_LT(found.cost_after, 0.01 * found.cost_before);
  // One of the two has the shiny one's exponent; noiseless floats and two mixing functions leave it within 2 %.
  const double sharper = std::max(found.basis[0].lobes[0][0].log_shape, found.basis[1].lobes[0][0].log_shape);
  EXPECT_NEAR(std::exp(sharper), 60.0, 1.2);
}

TEST(PrincipalFunctions, NothingMovesWhereNothingMayVary) {
  const Mixtures world;
  const auto found = principal_functions(world.observations, world.all, world.basis, ErrorModel(0.05, 1e-3), options_with({0.0, 0.0}));
  EXPECT_EQ(found.iterations, 0);
  EXPECT_EQ(found.basis[0].diffuse, world.basis[0].diffuse);
}

}  // namespace
}  // namespace lumitexel
