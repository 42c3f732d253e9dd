// The family whose samples they are is chosen where the data can tell.
#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>

#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

constexpr int kSeeds = 100, kWanted = 95;

class FamilyChoice : public testing::TestWithParam<BrdfFamily> {};

int seeds_that_find(BrdfFamily family, NoiseKind noise) {
  const bool lafortune = family == BrdfFamily::Lafortune;
  const Brdf truth = known_brdf(family, {lafortune ? KnownLobe{0.5, 30.0, kMirrorAim} : KnownLobe{0.15, 0.2}});
  std::atomic<int> right = 0;
  oneapi::tbb::parallel_for(1, kSeeds + 1, [&](int seed) {
    const NoisySamples data = noisy_samples(truth, 60, 0.03, noise, static_cast<unsigned>(seed));
    if (fit_best_family(data.samples, 3, {}).model.brdf.family == family) ++right;
  });
  testing::Test::RecordProperty("seeds_of_100", right);
  return right;
}

TEST_P(FamilyChoice, FindsTheTrueOne) { EXPECT_GE(seeds_that_find(GetParam(), NoiseKind::Independent), kWanted); }

TEST_P(FamilyChoice, FindsTheTrueOneWhereLumitexelsErrTogether) {
  EXPECT_GE(seeds_that_find(GetParam(), NoiseKind::LumitexelTogether), kWanted);
}

INSTANTIATE_TEST_SUITE_P(Families, FamilyChoice, testing::Values(BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward),
                         [](const auto& family) { return std::string(to_string(family.param)); });

}  // namespace
}  // namespace lumitexel
