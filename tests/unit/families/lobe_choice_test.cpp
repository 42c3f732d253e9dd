// The criterion for lobes: no where the data have none, yes where they have one, whatever goes together in the noise.
#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <cmath>

#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

constexpr int kSeeds = 100, kWanted = 95;
constexpr int kLumitexels = 60;
constexpr double kNoise = 0.05;

int seeds_with_lobes(const Brdf& truth, NoiseKind noise, std::size_t lobes, int most_lobes) {
  std::atomic<int> count = 0;
  oneapi::tbb::parallel_for(1, kSeeds + 1, [&](int seed) {
    const NoisySamples data = noisy_samples(truth, kLumitexels, kNoise, noise, static_cast<unsigned>(seed));
    MaterialFitOptions options;
    options.family = truth.family;
    options.most_lobes = most_lobes;
    if (fit_material(data.samples, 3, nullptr, options).model.brdf.lobes.size() == lobes) ++count;
  });
  return count;
}

int recorded(int count) {
  testing::Test::RecordProperty("seeds_of_100", count);
  return count;
}

class LobeChoice : public testing::TestWithParam<std::tuple<BrdfFamily, NoiseKind>> {
 protected:
  BrdfFamily family() const { return std::get<0>(GetParam()); }
  NoiseKind noise() const { return std::get<1>(GetParam()); }
  KnownLobe lobe() const {
    return family() == BrdfFamily::Lafortune ? KnownLobe{0.3, 20.0, kMirrorAim} : KnownLobe{0.05, 0.2};
  }
};

TEST_P(LobeChoice, GivesMatteDataNone) { EXPECT_GE(recorded(seeds_with_lobes(known_brdf(family(), {}), noise(), 0, 1)), kWanted); }

TEST_P(LobeChoice, GivesOneLobeDataOne) { EXPECT_GE(recorded(seeds_with_lobes(known_brdf(family(), {lobe()}), noise(), 1, 2)), kWanted); }

std::string name_of(const testing::TestParamInfo<std::tuple<BrdfFamily, NoiseKind>>& info) {
  const char* const kinds[] = {"independent", "channels", "lumitexels"};
  return std::string(to_string(std::get<0>(info.param))) + "_" + kinds[static_cast<int>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(Families, LobeChoice,
                         testing::Combine(testing::Values(BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward),
                                          testing::Values(NoiseKind::Independent, NoiseKind::ChannelsTogether, NoiseKind::LumitexelTogether)),
                         name_of);

TEST(LobeChoice, GivesTwoLobeDataTwo) {
  EXPECT_GE(seeds_with_lobes(known_brdf(BrdfFamily::Ward, {{0.1, 0.4}, {0.1, 0.1}}), NoiseKind::Independent, 2, 2), kWanted);
  EXPECT_GE(seeds_with_lobes(known_brdf(BrdfFamily::Lafortune, {{0.3, 8.0}, {2.0, 150.0}}), NoiseKind::Independent, 2, 2), kWanted);
}

// A highlight that one sample in sixty saw must not pass for the error of a matte surface.
int seeds_with_shape(const Brdf& truth, double factor) {
  std::atomic<int> count = 0;
  const double right = truth.lobes[0][0].log_shape, tolerance = std::log(factor);
  oneapi::tbb::parallel_for(1, kSeeds + 1, [&](int seed) {
    const NoisySamples data = noisy_samples(truth, 100, kNoise, NoiseKind::Independent, static_cast<unsigned>(seed));
    MaterialFitOptions options;
    options.family = truth.family;
    const Brdf found = fit_material(data.samples, 3, nullptr, options).model.brdf;
    if (found.lobes.size() == 1 && std::abs(found.lobes[0][0].log_shape - right) < tolerance) ++count;
  });
  return count;
}

TEST(RareHighlight, IsFoundWard) {
  EXPECT_GE(recorded(seeds_with_shape(known_brdf(BrdfFamily::Ward, {{0.05, 0.03}}), 1.25)), kWanted);
}
TEST(RareHighlight, IsFoundGgx) {
  EXPECT_GE(recorded(seeds_with_shape(known_brdf(BrdfFamily::Ggx, {{0.05, 0.03}}), 1.25)), kWanted);
}
// N goes with the square of the width.
TEST(RareHighlight, IsFoundLafortune) {
  EXPECT_GE(recorded(seeds_with_shape(known_brdf(BrdfFamily::Lafortune, {{10.0, 1500.0}}), 1.5)), kWanted);
}

}  // namespace
}  // namespace lumitexel
