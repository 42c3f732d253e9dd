// The descent itself: how far it reaches, that it only goes down, and that it stops where nothing is left to gain.
#include "processing/normals/smooth_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "processing/normals/fit_normals.h"
#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

// A patch and what the search needs of it. The patch must outlive it.
struct Search {
  DirectedLumitexels lumitexels;
  Neighbours neighbours;
  std::vector<NormalMaterial> materials;
  NormalProblem problem;

  explicit Search(const NormalPatch& patch)
      : lumitexels(patch.session, patch.lumitexels),
        neighbours(lumitexel_neighbours(lumitexels, patch.width)),
        materials(normal_materials(patch.bases, 3, patch.median_reflectance, {})),
        problem{lumitexels, neighbours, materials, patch.label} {}
};

// The mesh's normals all off the truth by one angle.
NormalPatch leaning(double angle_rad) {
  NormalPatch patch = make_patch({16, 12, 0.0, 0.02, 1});
  for (LumitexelTile& tile : patch.lumitexels.tiles) {
    for (Eigen::Vector3d& normal : tile.normal) normal = (normal + std::tan(angle_rad) * Eigen::Vector3d(0.6, -0.8, 0.0)).normalized();
  }
  return patch;
}

// Steps are .06 rad at most; a fixed few of them ended short of what samples say plainly.
TEST(SmoothNormals, ReachATruthThirtyDegreesOffTheMesh) {
  const NormalPatch patch = leaning(std::numbers::pi / 6.0);
  const Search search(patch);
  const NormalField reached = smooth_normals(search.problem, field_on_mesh(search.problem), {NormalPrior::alone(), 40, 0.06});
  constexpr double kOfNoise_rad = 0.03;  // two per cent of noise in twelve samples; several times what comes out
  EXPECT_LT(rms_angle(reached.normal, patch.truth), kOfNoise_rad);
}

TEST(SmoothNormals, EveryStepGoesDown) {
  const NormalPatch patch = make_patch({24, 12, 0.12, 0.05, 3});
  const Search search(patch);
  const NormalPrior prior;
  NormalField field = field_on_mesh(search.problem);
  for (int step = 0; step < 12; ++step) {
    const NormalField before = field;
    field = smooth_normals(search.problem, std::move(field), {prior, 1, 0.06});
    EXPECT_LE(normal_objective(search.problem, field, before, prior), normal_objective(search.problem, before, before, prior)) << step;
  }
}

// Where it stops by itself, no lumitexel has anything to gain by a step of its own, of a tenth of its sigma or of a whole one, any way.
TEST(SmoothNormals, StopWhereNothingIsLeftToGain) {
  const NormalPatch patch = make_patch({24, 12, 0.12, 0.05, 3});
  const Search search(patch);
  const NormalPrior prior;
  int taken = 0;
  const NormalField reached = smooth_normals(search.problem, field_on_mesh(search.problem), {prior, 200, 0.06}, [&](int step) { taken = step; });
  EXPECT_LT(taken, 200);
  const NormalSigmas sigma = normal_sigmas(search.problem, reached, prior);
  const double settled = normal_objective(search.problem, reached, reached, prior);
  constexpr double kOfE = 0.05;  // a step of a whole sigma costs about 1
  std::mt19937 random(1);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < reached.normal.size(); i += 7) {
    for (const double sigmas : {0.1, 1.0}) {
      NormalField beside = reached;
      const double angle = turn(random), step = sigmas * std::hypot(static_cast<double>(sigma.samples_rad[i]), static_cast<double>(sigma.prior_rad[i]));
      beside.normal[i] = moved(beside.normal[i], tangent_frame(beside.normal[i]), {step * std::cos(angle), step * std::sin(angle)});
      EXPECT_GT(normal_objective(search.problem, beside, reached, prior), settled - kOfE) << i << " by " << sigmas << " sigma";
    }
  }
}

}  // namespace
}  // namespace lumitexel
