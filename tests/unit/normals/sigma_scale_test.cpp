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

// Every photograph off by a gain that changes every eight texels: what neighbours share and a sigma from independent samples cannot know.
void add_shared_errors(NormalPatch& patch, double relative, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> draw;
  const int blocks = patch.width / 8 + 1;
  std::vector<double> gain(patch.session.views.size() * static_cast<std::size_t>(blocks * blocks));
  for (double& value : gain) value = 1.0 + relative * draw(random);
  for (LumitexelTile& tile : patch.lumitexels.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const int x = static_cast<int>(tile.texel[i]) % patch.width / 8, y = static_cast<int>(tile.texel[i]) / patch.width / 8;
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

TEST(NormalSigmaScale, WidensSigmasToTheErrorsThatNeighboursShare) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    NormalPatch patch = make_patch({40, 12, 0.05, 0.03, seed});
    add_shared_errors(patch, 0.15, seed);
    const double scale = scale_of(patch);
    const DirectedLumitexels lumitexels(patch.session, patch.lumitexels);
    const FittedNormals fitted = fit_normals(lumitexels, lumitexel_neighbours(lumitexels, patch.width), patch.bases, patch.label,
                                             patch.median_reflectance, as_the_patch_errs());
    double stated = 0.0;
    for (const float sigma : fitted.sigma_rad) stated += 2.0 * std::pow(static_cast<double>(sigma), 2);
    const double over = rms_angle(fitted.normal, patch.truth) / std::sqrt(stated / static_cast<double>(patch.truth.size()));
    EXPECT_GT(over, 1.5) << seed;          // the patch does what it is for
    EXPECT_LT(over / scale, 1.5) << seed;  // most of it is seen
    EXPECT_GT(over / scale, 0.6) << seed;  // and no more
  }
}

TEST(NormalSigmaScale, IsOneWhereNothingCanBeCompared) { EXPECT_EQ(scale_of(make_patch({20, 4, 0.05, 0.03, 1})), 1.0); }

}  // namespace
}  // namespace lumitexel
