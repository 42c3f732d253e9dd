#include "processing/normals/sigma_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

NormalFitOptions as_the_patch_errs() {
  NormalFitOptions options;
  options.relative_error = 0.03;
  options.floor_share = 1e-3;
  options.texel = {0.0, 0.0};
  return options;
}

double scale_of(const NormalPatch& patch) {
  return normal_sigma_scale(patch.session, patch.lumitexels, patch.width, patch.bases, patch.label, patch.median_reflectance,
                            as_the_patch_errs());
}

// Every photograph off by a gain that changes every few texels: what neighbours share and a sigma from independent samples cannot know.
void add_shared_errors(NormalPatch& patch, double relative, unsigned seed, int texels = 8) {
  std::mt19937 random(seed);
  std::normal_distribution<double> draw;
  const int blocks = patch.width / texels + 1;
  std::vector<double> gain(patch.session.views.size() * static_cast<std::size_t>(blocks * blocks));
  for (double& value : gain) value = 1.0 + relative * draw(random);
  for (LumitexelTile& tile : patch.lumitexels.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const int x = static_cast<int>(tile.texel[i]) % patch.width / texels, y = static_cast<int>(tile.texel[i]) / patch.width / texels;
      for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
        const auto at = tile.view[s] * static_cast<std::size_t>(blocks * blocks) + static_cast<std::size_t>(y * blocks + x);
        for (std::size_t c = 0; c < 3; ++c) tile.reflectance[3 * s + c] *= static_cast<float>(gain[at]);
      }
    }
  }
}

TEST(NormalSigmaScale, IsOneWhereSamplesErrIndependently) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const double scale = scale_of(make_patch({40, 12, 0.05, 0.03, seed}));
    EXPECT_LT(scale, 1.2) << seed;  // sigmas come from 8 draws
  }
}

// With three samples a half and three unknowns, one half's determine a normal along an axis that the other's leave to the mesh: they disagree by
// the surface's own tilt, which is no error of the samples. Taken for one, it made scales of up to 1.46 here.
TEST(NormalSigmaScale, IsOneWhereHalvesDisagreeByWhatOneOfThemDidNotSee) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    NormalFitOptions options = as_the_patch_errs();
    options.prior = {0.05, 1e3, 1e3};  // as the surface tilts
    options.texel = {1.0, 1.0};        // the third unknown is the brightness
    const NormalPatch patch = make_patch({40, 6, 0.05, 0.03, seed});
    EXPECT_LT(normal_sigma_scale(patch.session, patch.lumitexels, patch.width, patch.bases, patch.label, patch.median_reflectance, options), 1.1)
        << seed;
  }
}

TEST(NormalSigmaScale, WidensSigmasToTheErrorsThatNeighboursShare) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    NormalPatch patch = make_patch({40, 12, 0.05, 0.03, seed});
    add_shared_errors(patch, 0.15, seed);
    const double scale = scale_of(patch);
    const DirectedLumitexels lumitexels(patch.session, patch.lumitexels);
    const FittedNormals fitted = fit_normals(lumitexels, lumitexel_neighbours(lumitexels, patch.width), patch.bases, patch.label,
                                             patch.median_reflectance, as_the_patch_errs(), Uncertainty::Sigmas);
    const auto error_over_sigma = [&](double wider) {
      double stated = 0.0;
      for (const float sigma : widened(fitted.sigma, wider, {})) stated += 2.0 * std::pow(static_cast<double>(sigma), 2);
      return rms_angle(fitted.normal, patch.truth) / std::sqrt(stated / static_cast<double>(patch.truth.size()));
    };
    EXPECT_GT(error_over_sigma(1.0), 1.5) << seed;    // the patch does what it is for
    EXPECT_LT(error_over_sigma(scale), 1.25) << seed;  // it is seen
    EXPECT_GT(error_over_sigma(scale), 0.6) << seed;  // and no more
  }
}

// Where samples say little both halves hold on to the mesh, which is no sign that their sigmas are right: errors that the fit knows nothing of,
// five times as large as the sigma of a lumitexel's brightness says, show under a prior that leaves normals hardly any room, too. Less than
// under a wide one, since residuals stay large there and count less: 1.5 to 2.9.
TEST(NormalSigmaScale, IsNotHiddenByAPriorThatBothHalvesShare) {
  NormalFitOptions narrow = as_the_patch_errs();
  narrow.prior.coarse_sigma_rad = 0.002;
  const auto scale = [&](const NormalPatch& patch) {
    return normal_sigma_scale(patch.session, patch.lumitexels, patch.width, patch.bases, patch.label, patch.median_reflectance, narrow);
  };
  NormalPatch patch = make_patch({40, 12, 0.0, 0.03, 1});
  EXPECT_LT(scale(patch), 1.1);
  add_shared_errors(patch, 0.09, 1, 1);
  EXPECT_GT(scale(patch), 1.3);
}

TEST(NormalSigmaScale, WidensTheSamplesPartUpToThePrior) {
  NormalPrior prior;
  prior.coarse_sigma_rad = 0.07;
  const std::vector<float> sigma = widened({{0.003f, 0.0f, 0.05f}, {0.008f, 0.06f, 0.0f}}, 2.0, prior);
  EXPECT_FLOAT_EQ(sigma[0], 0.01f);
  EXPECT_FLOAT_EQ(sigma[1], 0.06f);
  EXPECT_FLOAT_EQ(sigma[2], 0.07f);
}

TEST(NormalSigmaScale, IsOneWhereNothingCanBeCompared) { EXPECT_EQ(scale_of(make_patch({20, 4, 0.05, 0.03, 1})), 1.0); }

}  // namespace
}  // namespace lumitexel
