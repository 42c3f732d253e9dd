// A normal that faces away from a photograph would explain every dark sample in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "processing/normals/fit_normals.h"
#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFlatViews = 5;
constexpr double kFlatPolar_rad = 1.48;  // the first views see the patch 5 degrees from edge on

// The flat views' samples are black, as where a shadow was missed.
NormalPatch patch_with_black_flat_views() {
  NormalPatch patch = make_patch({12, 8, 0.0, 0.03, 1});
  for (std::size_t v = 0; v < kFlatViews; ++v) {
    const double azimuth = 0.1 * static_cast<double>(v);
    patch.session.views[v].camera_from_world.translation() =
        -Eigen::Vector3d(std::sin(kFlatPolar_rad) * std::cos(azimuth), std::sin(kFlatPolar_rad) * std::sin(azimuth), std::cos(kFlatPolar_rad));
  }
  for (LumitexelTile& tile : patch.lumitexels.tiles) {
    for (std::size_t s = 0; s < tile.view.size(); ++s) {
      if (tile.view[s] >= kFlatViews) continue;
      for (std::size_t c = 0; c < 3; ++c) tile.reflectance[3 * s + c] = tile.variance[3 * s + c] = 0.0f;
    }
  }
  return patch;
}

// Each texel by its samples alone, and many steps: nothing but the hemisphere holds a normal.
NormalFitOptions unheld() {
  NormalFitOptions options;
  options.prior = NormalPrior::alone();
  options.most_steps = 12;
  return options;
}

// The cosine between a fitted normal and the view that sees it at the flattest: the least over the patch.
double least_facing(const NormalPatch& patch) {
  const DirectedLumitexels lumitexels(patch.session, patch.lumitexels);
  const FittedNormals fitted = fit_normals(lumitexels, lumitexel_neighbours(lumitexels, patch.width), patch.bases, patch.label,
                                           patch.median_reflectance, unheld(), Uncertainty::None);
  double least = 1.0;
  for (std::size_t i = 0; i < lumitexels.size(); ++i) {
    std::vector<DirectedSample> samples;
    lumitexels.samples_of(i, samples);
    for (const DirectedSample& sample : samples) least = std::min(least, fitted.normal[i].dot(sample.wo));
  }
  return least;
}

TEST(VisibleHemisphere, NormalsFaceEveryPhotographTheyWereSeenIn) {
  const double least = least_facing(patch_with_black_flat_views());
  std::printf("least cosine %.4f, edge on as the mesh has it %.4f\n", least, std::cos(kFlatPolar_rad));
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.5 * std::cos(kFlatPolar_rad)) << "black samples turn normals away, up to where they may not";
}

}  // namespace
}  // namespace lumitexel
