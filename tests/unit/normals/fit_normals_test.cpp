#include "processing/normals/sigma_scale.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

FittedNormals fit(const NormalPatch& patch, const NormalFitOptions& options = {}) {
  const DirectedLumitexels lumitexels(patch.session, patch.lumitexels);
  return fit_normals(lumitexels, lumitexel_neighbours(lumitexels, patch.width), patch.bases, patch.label, patch.median_reflectance,
                     options, Uncertainty::Sigmas);
}

// Errors as the patch makes them: for tests of what follows from noise alone.
NormalFitOptions as_the_patch_errs(double noise) {
  NormalFitOptions options;
  options.relative_error = noise;
  options.floor_share = 1e-3;
  options.texel = {0.0, 0.0};
  return options;
}

std::vector<float> whole_sigma(const FittedNormals& fitted) { return widened(fitted.sigma, 1.0, {}); }

TEST(FitNormals, FindsABumpySurfaceUnderNoise) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const NormalPatch patch = make_patch({40, 12, 0.07, 0.03, seed});
    const double mesh = rms_angle(mesh_normals(patch), patch.truth), fitted = rms_angle(fit(patch).normal, patch.truth);
    EXPECT_NEAR(mesh, 0.07 * std::sqrt(2.0), 0.02);  // what the patch was told
    EXPECT_LT(fitted, 0.2 * mesh) << seed;           // a fifth: the fit expects errors of 5 % beside the noise, and holds on to the mesh
  }
}

TEST(FitNormals, LeavesAnExactMeshNearlyAsItIs) {
  const NormalPatch patch = make_patch({40, 12, 0.0, 0.03, 1});
  const FittedNormals fitted = fit(patch);
  double squares = 0.0;
  for (const float sigma : whole_sigma(fitted)) squares += 2.0 * std::pow(static_cast<double>(sigma), 2);
  EXPECT_LT(rms_angle(fitted.normal, patch.truth), std::sqrt(squares / static_cast<double>(patch.truth.size())));  // what it claims
  EXPECT_LT(rms_angle(fitted.normal, patch.truth), 0.2 * NormalPrior().coarse_sigma_rad);
}

// Where the prior is as wide as the surface's slopes, a sigma says how far off a normal is. Sigmas come from 8 draws (18 %), and the
// surface's neighbours go together more than the prior has it: on the safe side, which the lower bound allows for.
TEST(FitNormals, SigmasAreAsLargeAsErrors) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const NormalPatch patch = make_patch({40, 6, 0.07, 0.05, seed});
    const FittedNormals fitted = fit(patch, as_the_patch_errs(0.05));
    const std::vector<float> sigma = whole_sigma(fitted);
    for (std::size_t i = 0; i < patch.truth.size(); ++i) {
      squares += std::pow(angle_rad(fitted.normal[i], patch.truth[i]), 2) / (2.0 * std::pow(static_cast<double>(sigma[i]), 2));
      ++count;
    }
  }
  const double ratio = std::sqrt(squares / static_cast<double>(count));
  RecordProperty("error_over_sigma", std::to_string(ratio));
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 1.2);
}

void drop_samples(NormalPatch& patch, std::size_t first, std::size_t last) {
  LumitexelTile& tile = patch.lumitexels.tiles.front();
  const auto from = static_cast<std::ptrdiff_t>(tile.first_sample[first]), to = static_cast<std::ptrdiff_t>(tile.first_sample[last]);
  tile.view.erase(tile.view.begin() + from, tile.view.begin() + to);
  tile.reflectance.erase(tile.reflectance.begin() + 3 * from, tile.reflectance.begin() + 3 * to);
  tile.variance.erase(tile.variance.begin() + 3 * from, tile.variance.begin() + 3 * to);
  for (std::size_t i = first + 1; i < tile.first_sample.size(); ++i) {
    tile.first_sample[i] = i <= last ? tile.first_sample[first] : tile.first_sample[i] - static_cast<std::uint32_t>(to - from);
  }
}

// Nine texels amid others have no sample. The rms of their sigmas, from 9 times 32 numbers, is known to 4 %: it is 1.4 times the others',
// and four sigmas below that is the bound.
TEST(FitNormals, WhereSamplesSayNothingNeighboursDecideAndSigmaIsWider) {
  NormalPatch patch = make_patch({40, 12, 0.07, 0.02, 1});
  std::vector<std::size_t> alone;
  for (const std::size_t y : {10u, 20u, 30u}) {
    for (const std::size_t x : {10u, 20u, 30u}) alone.push_back(y * 40 + x);
  }
  for (const std::size_t i : alone) drop_samples(patch, i, i + 1);
  const FittedNormals fitted = fit(patch);
  const std::vector<float> sigma = whole_sigma(fitted);
  double squares_alone = 0.0, squares = 0.0, off = 0.0, off_mesh = 0.0;
  for (const std::size_t i : alone) {
    off += std::pow(angle_rad(fitted.normal[i], patch.truth[i]), 2);
    off_mesh += std::pow(angle_rad(Eigen::Vector3d::UnitZ(), patch.truth[i]), 2);
    squares_alone += std::pow(static_cast<double>(sigma[i]), 2) / static_cast<double>(alone.size());
  }
  for (const float other : sigma) squares += std::pow(static_cast<double>(other), 2) / static_cast<double>(sigma.size());
  EXPECT_LT(std::sqrt(off), 0.5 * std::sqrt(off_mesh));
  EXPECT_GT(std::sqrt(squares_alone), 1.15 * std::sqrt(squares));
}

// As the paper has it: what its neighbours saw is nothing to a texel.
TEST(FitNormals, AloneEachTexelGoesByItsOwnSamples) {
  NormalPatch patch = make_patch({40, 12, 0.07, 0.02, 1});
  NormalFitOptions options;
  options.prior = NormalPrior::alone();
  const FittedNormals all = fit(patch, options);
  EXPECT_LT(rms_angle(all.normal, patch.truth), 0.5 * rms_angle(mesh_normals(patch), patch.truth));
  const std::size_t kept = 20 * 40 + 20;
  drop_samples(patch, kept + 1, patch.truth.size());
  drop_samples(patch, 0, kept);
  const FittedNormals one = fit(patch, options);
  EXPECT_LT(angle_rad(one.normal[kept], all.normal[kept]), 1e-4);  // neighbours still count for a millionth of a sample
  EXPECT_LT(angle_rad(one.normal[0], Eigen::Vector3d::UnitZ()), 1e-4) << "nothing moves where nobody looked";
}

TEST(FitNormals, WithoutAnySampleTheMeshStaysAndSigmaIsThePriors) {
  NormalPatch patch = make_patch({12, 6, 0.07, 0.02, 1});
  drop_samples(patch, 0, patch.truth.size());
  const NormalFitOptions options;
  const FittedNormals fitted = fit(patch, options);
  double squares = 0.0;
  for (std::size_t i = 0; i < patch.truth.size(); ++i) {
    EXPECT_EQ(fitted.normal[i], Eigen::Vector3d::UnitZ());
    squares += std::pow(static_cast<double>(fitted.sigma.prior_rad[i]), 2);
    EXPECT_LT(fitted.sigma.samples_rad[i], 1e-3f) << "samples that are not there do not err";
  }
  // Neighbours that go together know a little more than each alone: under the prior of one, over a third of it.
  const double sigma = std::sqrt(squares / static_cast<double>(patch.truth.size()));
  EXPECT_LT(sigma, options.prior.coarse_sigma_rad);
  EXPECT_GT(sigma, 0.3 * options.prior.coarse_sigma_rad);
}

// A surface has no curl: with two samples a texel, which often cannot tell both slopes, knowing that helps.
TEST(FitNormals, AbsenceOfCurlMakesUpForFewSamples) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    NormalPatch patch = make_patch({40, 12, 0.07, 0.03, seed});
    for (std::size_t i = 0; i < patch.truth.size(); ++i) {
      const std::size_t size = patch.lumitexels.tiles.front().first_sample[i + 1] - patch.lumitexels.tiles.front().first_sample[i];
      LumitexelTile& tile = patch.lumitexels.tiles.front();
      // Two different ones at every texel.
      for (std::size_t s = 0; s < size; ++s) {
        if (s == i % size || s == (i * 7 + 3) % size) continue;
        for (std::size_t c = 0; c < 3; ++c) tile.reflectance[3 * (tile.first_sample[i] + s) + c] = std::numeric_limits<float>::quiet_NaN();
      }
    }
    NormalFitOptions free;
    free.prior.curl_sigma_rad = 1e3;
    EXPECT_LT(rms_angle(fit(patch).normal, patch.truth), rms_angle(fit(patch, free).normal, patch.truth)) << seed;
  }
}

TEST(FitNormals, SamplesThatAreNoNumbersAreAsIfAbsent) {
  NormalPatch patch = make_patch({20, 8, 0.07, 0.02, 1}), spoilt = patch;
  spoilt.lumitexels.tiles.front().reflectance[3 * spoilt.lumitexels.tiles.front().first_sample[30]] = std::numeric_limits<float>::infinity();
  const std::size_t sample = patch.lumitexels.tiles.front().first_sample[30];
  LumitexelTile& tile = patch.lumitexels.tiles.front();
  tile.view.erase(tile.view.begin() + static_cast<std::ptrdiff_t>(sample));
  for (int c = 0; c < 3; ++c) {
    tile.reflectance.erase(tile.reflectance.begin() + static_cast<std::ptrdiff_t>(3 * sample));
    tile.variance.erase(tile.variance.begin() + static_cast<std::ptrdiff_t>(3 * sample));
  }
  for (std::size_t i = 31; i < tile.first_sample.size(); ++i) --tile.first_sample[i];
  EXPECT_EQ(fit(patch).normal, fit(spoilt).normal);
}

TEST(FitNormals, HaveTheSameBitsForAnyNumberOfThreads) {
  const NormalPatch patch = make_patch({60, 8, 0.07, 0.03, 1});  // more than one block of the sums
  std::vector<FittedNormals> results;
  for (const std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(fit(patch));
  }
  for (const FittedNormals& other : results) {
    EXPECT_EQ(other.normal, results[0].normal);
    EXPECT_EQ(other.sigma.samples_rad, results[0].sigma.samples_rad);
    EXPECT_EQ(other.sigma.prior_rad, results[0].sigma.prior_rad);
  }
}

// Two planes that meet: neighbours across the edge are no reason to round it.
TEST(FitNormals, KeepAnEdge) {
  const int side = 40;
  const NormalPatch patch = make_patch({side, 12, 0.0, 0.02, 5, 0.0, 0.2});
  const FittedNormals fitted = fit(patch);
  double beside = 0.0;
  for (int y = 5; y < side - 5; ++y) {
    for (const int x : {side / 2 - 1, side / 2}) {
      const auto i = static_cast<std::size_t>(y * side + x);
      beside += angle_rad(fitted.normal[i], patch.truth[i]) / (2.0 * (side - 10));
    }
  }
  EXPECT_LT(beside, 0.1 * 0.2);  // a tenth of the slope; half way up a rounded edge it would be all of it
}

}  // namespace
}  // namespace lumitexel
