#include "processing/fit/normal_trial.h"

#include <gtest/gtest.h>

#include "processing/brdf/select_lumitexels.h"
#include "processing/fit/observe.h"
#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

NormalsWorth trial(const NormalPatch& patch) {
  Atlas atlas;
  atlas.width = atlas.height = patch.width;
  const Observations observations = observe(patch.session, patch.lumitexels);
  FitOptions options = FitOptions::preset("draft");
  options.materials = 1;
  options.learning_lumitexels = options.final_lumitexels = 500;  // enough for one material, in half the time
  const ErrorModel error = error_model(observations, options);
  const FitInputs inputs{atlas, patch.lumitexels, observations, options, error};
  Model model;
  FitSummary summary;
  StageTimer timer;
  NoProgress quiet;
  Clustering materials;  // none where a fit would have refused the session
  if (!select_lumitexels(observations, options.learning_lumitexels).empty()) {
    materials = fit_reflectance(inputs, {}, "", model, summary, timer, quiet).clustering;
  }
  return try_normals(patch.session, inputs, materials);
}

int said_yes(double slope_rms_rad, int seeds) {
  int yes = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const NormalsWorth found = trial(make_patch({64, 15, slope_rms_rad, 0.05, static_cast<unsigned>(seed), 1.0}));
    yes += found.enough();
    std::printf("slope %.2f, seed %d: gain %.4f +- %.4f\n", slope_rms_rad, seed, found.gain, found.gain_sigma);
  }
  return yes;
}

// 64 texels square: twelve parts to compare, four in each of three photographs.
TEST(NormalTrial, AnExactMeshKeepsItsNormals) { EXPECT_EQ(said_yes(0.0, 3), 0); }
TEST(NormalTrial, ABumpySurfaceGetsItsOwn) { EXPECT_EQ(said_yes(0.07, 3), 3); }

// Fewer than two parts, and so no sigma, are not an answer, however many samples they have.
TEST(NormalsWorth, IsClearOnlyFarFromWhatIsAskedFor) {
  EXPECT_FALSE((NormalsWorth{0.0, 0.0, 0}.is_clear()));
  EXPECT_FALSE((NormalsWorth{0.0, 0.0, 1000}.is_clear()));
  EXPECT_FALSE((NormalsWorth{0.2, 0.1, 1000}.is_clear()));
  EXPECT_TRUE((NormalsWorth{0.4, 0.1, 1000}.is_clear()));
  EXPECT_TRUE((NormalsWorth{-0.4, 0.1, 1000}.is_clear()));
}

// The campaign behind the two, too long for every run: target run_normals_campaign. What it last gave is in the README.
TEST(NormalTrial, DISABLED_HundredSeeds) {
  EXPECT_LE(said_yes(0.0, 100), 5);
  EXPECT_GE(said_yes(0.07, 100), 95);
}

TEST(NormalTrial, OnePhotographDecidesNothing) {
  const NormalsWorth found = trial(make_patch({20, 1, 0.05, 0.05, 1}));
  EXPECT_FALSE(found.enough());
}

// Three photographs, one of which is left out: too few samples to learn materials on, where the fit itself had enough.
TEST(NormalTrial, DecidesNothingWhereTheOthersAreTooFew) {
  const NormalsWorth found = trial(make_patch({20, 3, 0.05, 0.05, 1}));
  EXPECT_FALSE(found.enough());
  EXPECT_EQ(found.samples, 0u);
}

TEST(NormalTrial, HeldOutPhotographsAreNotLookedAt) {
  NormalPatch patch = make_patch({40, 10, 0.05, 0.05, 1});
  for (View& view : patch.session.views) view.heldout = true;
  EXPECT_EQ(trial(patch).samples, 0u);
}

}  // namespace
}  // namespace lumitexel
