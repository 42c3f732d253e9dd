// A normal that faces away from a photograph would explain every dark sample in it.
#include <gtest/gtest.h>

#include <cmath>

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

// Each texel by its samples alone, and long steps: nothing but the hemisphere holds a normal.
NormalFitOptions unheld() {
  NormalFitOptions options;
  options.prior = NormalPrior::alone();
  options.steps = 12;
  return options;
}

TEST(VisibleHemisphere, NormalsFaceEveryPhotographTheyWereSeenIn) {
  const NormalPatch patch = patch_with_black_flat_views();
  const DirectedLumitexels lumitexels(patch.session, patch.lumitexels);
  const FittedNormals fitted = fit_normals(lumitexels, lumitexel_neighbours(lumitexels, patch.width), patch.bases, patch.label,
                                           patch.median_reflectance, unheld(), Uncertainty::None);
  double furthest = 0.0;
  for (std::size_t i = 0; i < lumitexels.size(); ++i) {
    std::vector<DirectedSample> samples;
    lumitexels.samples_of(i, samples);
    for (const DirectedSample& sample : samples) EXPECT_GT(fitted.normal[i].dot(sample.wo), 0.0) << i;
    furthest = std::max(furthest, angle_rad(fitted.normal[i], lumitexels.coarse_normal(i)));
  }
  EXPECT_GT(furthest, 0.02);  // they did turn away as far as they may
}

}  // namespace
}  // namespace lumitexel
