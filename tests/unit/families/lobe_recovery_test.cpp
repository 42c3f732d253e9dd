// Lobes of every kind and number, found from noisy samples and held against the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "processing/brdf/misfit.h"
#include "processing/brdf/mixture.h"
#include "processing/brdf/split_directions.h"
#include "tests/unit/families/known_brdfs.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kNoise = 0.02;
constexpr int kLumitexels = 600;  // 3000 samples, 1200 of them near the mirror direction

std::vector<std::array<Lobe, kMaxChannels>> sorted(std::vector<std::array<Lobe, kMaxChannels>> lobes) {
  std::sort(lobes.begin(), lobes.end(), [](const auto& a, const auto& b) {
    return std::pair(a[0].aim < 0.0, a[0].log_shape) < std::pair(b[0].aim < 0.0, b[0].log_shape);
  });
  return lobes;
}

// tolerance: of kd and the lobes' strengths and shapes, relative.
void expect_truth(const Brdf& found, const Brdf& truth, double tolerance) {
  ASSERT_EQ(found.lobes.size(), truth.lobes.size());
  const auto lobes = sorted(found.lobes), wanted = sorted(truth.lobes);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.diffuse[c], truth.diffuse[c], tolerance * truth.diffuse[c]) << "channel " << c;
    for (std::size_t l = 0; l < lobes.size(); ++l) {
      EXPECT_NEAR(lobes[l][c].log_strength, wanted[l][c].log_strength, tolerance) << "lobe " << l << ", channel " << c;
      EXPECT_NEAR(lobes[l][c].log_shape, wanted[l][c].log_shape, tolerance) << "lobe " << l << ", channel " << c;
      EXPECT_NEAR(lobes[l][c].aim, wanted[l][c].aim, 0.1 * tolerance) << "lobe " << l << ", channel " << c;
    }
  }
}

Brdf found_in(const NoisySamples& data, int most_lobes) {
  MaterialFitOptions options;
  options.most_lobes = most_lobes;
  return fit_material(data.samples, 3, nullptr, options).model.brdf;
}

TEST(LobeRecovery, ALobeThatPointsBackAtTheLight) {
  const Brdf truth = known_brdf(BrdfFamily::Lafortune, {{0.4, 30.0}, {0.5, 8.0, -kMirrorAim}});
  for (unsigned seed = 1; seed <= 3; ++seed) expect_truth(found_in(noisy_samples(truth, kLumitexels, kNoise, NoiseKind::Independent, seed), 2), truth, 0.05);
}

TEST(LobeRecovery, ThreeLobes) {
  const Brdf truth = known_brdf(BrdfFamily::Lafortune, {{0.4, 4.0}, {1.5, 60.0}, {0.5, 8.0, -kMirrorAim}});
  for (unsigned seed = 1; seed <= 3; ++seed) expect_truth(found_in(noisy_samples(truth, kLumitexels, kNoise, NoiseKind::Independent, seed), 3), truth, 0.1);
}

// As far as the bounds of an aim let it start: half a radian is 29 degrees, three times the half width of this lobe.
TEST(LobeRecovery, AStartAimedHalfARadianWrongConverges) {
  const Brdf truth = known_brdf(BrdfFamily::Lafortune, {{0.5, 40.0}});
  const NoisySamples data = noisy_samples(truth, kLumitexels, kNoise, NoiseKind::Independent, 1);
  BrdfFitOptions options;
  options.bounds = {widest_bounds(BrdfFamily::Lafortune)};
  for (const double wrong : {-0.5, 0.5}) {
    Brdf start = truth;
    for (Lobe& lobe : start.lobes[0]) lobe.aim += wrong;
    const BrdfFit fit = fit_brdf(start, data.samples, options);
    EXPECT_TRUE(fit.converged) << wrong;
    expect_truth(fit.brdf, truth, 0.05);
  }
}

// One BRDF fitted to two materials, parted, and each part fitted to the lumitexels that it explains better, a few times over.
TEST(LobeRecovery, SplittingAlongTheCovariancePartsTwoBrdfs) {
  const std::array truth{one_lobe({0.20, 0.15, 0.10}, {0.3, 0.3, 0.3}, kMirrorAim, 10.0), one_lobe({0.10, 0.08, 0.20}, {0.9, 0.9, 0.9}, kMirrorAim, 50.0)};
  std::mt19937 random(1);
  Observations observations;
  for (const Brdf& brdf : truth) add_lumitexels(observations, brdf, 200, 6, kNoise, random);
  const ErrorModel error(kNoise, 1e-3);
  LumitexelList everyone(observations.lumitexels());
  std::iota(everyone.begin(), everyone.end(), std::size_t{0});
  MaterialFitOptions options;
  options.error = error;
  options.estimate_error = false;
  const MaterialFit whole = fit_material(samples_of(observations, everyone), 3, nullptr, options);
  const BrdfPair pair = split_along_covariance(whole.fit.brdf, whole.fit.covariance, parameters_of(whole.fit.brdf, refit_options(whole.model, options)));
  std::array parts{pair.first, pair.second};
  for (int round = 0; round < 10; ++round) {
    std::array<LumitexelList, 2> members;
    for (const std::size_t l : everyone) members[misfit(parts[1], observations.of(l), error) < misfit(parts[0], observations.of(l), error)].push_back(l);
    for (std::size_t k = 0; k < 2; ++k) parts[k] = fit_material(samples_of(observations, members[k]), 3, &parts[k], options).model.brdf;
  }
  if (parts[0].diffuse[2] > parts[1].diffuse[2]) std::swap(parts[0], parts[1]);
  for (std::size_t k = 0; k < 2; ++k) expect_truth(parts[k], truth[k], 0.05);
}

}  // namespace
}  // namespace lumitexel
