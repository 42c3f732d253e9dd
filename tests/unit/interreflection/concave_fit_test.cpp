// fit_model on a concave object: light between its surfaces is taken out where the photographs show it, and put back where they do not.
#include <gtest/gtest.h>

#include "processing/fit/fit_model.h"
#include "tests/unit/interreflection/bowl_session.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

FittedModel fit_bowl(const CalibratedSession& session, InterreflectionChoice choice) {
  FitOptions options = FitOptions::preset("draft");
  options.materials = 1;
  options.errors = ErrorSource::Given;
  options.interreflections.choice = choice;
  NoProgress progress;
  return fit_model(session, options, {}, progress);
}

double albedo(const FittedModel& fitted) { return M_PI * fitted.model.materials.front().brdf.diffuse[0]; }

// Its light would be a third of the lamp's here, and the fit's model predicts it. No photograph has it.
TEST(ConcaveFit, WhatNoPhotographShowsIsPutBackAndLeavesNoTrace) {
  const TemporaryFolder folder;
  const CalibratedSession session = photographed_bowl(0, folder);
  const FittedModel tried = fit_bowl(session, InterreflectionChoice::Auto), never = fit_bowl(session, InterreflectionChoice::Off);
  ASSERT_TRUE(tried.summary.indirect && tried.summary.indirect->worth);
  EXPECT_FALSE(tried.summary.indirect->change.empty()) << "it was taken out, to see";
  EXPECT_TRUE(tried.summary.indirect->worth->judged());
  EXPECT_FALSE(tried.summary.indirect->worth->enough()) << "slope " << tried.summary.indirect->worth->slope;
  EXPECT_EQ(tried.summary.indirect->share, 0.0);
  EXPECT_EQ(tried.model.indirect_bounces, 0);
  EXPECT_EQ(tried.model.weights.data, never.model.weights.data);
  EXPECT_EQ(tried.model.materials.front().brdf.diffuse, never.model.materials.front().brdf.diffuse);
  EXPECT_EQ(tried.summary.samples, never.summary.samples);
}

// One round leaves a tenth of a fault of two fifths (IndirectRemoval.TheTrueAlbedo...), and half a pixel of the rim's slope some percent.
TEST(ConcaveFit, WhatPhotographsShowIsTakenOut) {
  const TemporaryFolder folder;
  const CalibratedSession session = photographed_bowl(3, folder);
  const FittedModel without = fit_bowl(session, InterreflectionChoice::Auto), with = fit_bowl(session, InterreflectionChoice::Off);
  ASSERT_TRUE(without.summary.indirect && without.summary.indirect->worth);
  EXPECT_TRUE(without.summary.indirect->worth->enough()) << "slope " << without.summary.indirect->worth->slope;
  EXPECT_GT(without.model.indirect_bounces, 0);
  EXPECT_GT(albedo(with), 1.2 * kSphereAlbedo);
  EXPECT_NEAR(albedo(without), kSphereAlbedo, 0.1 * kSphereAlbedo);
}

}  // namespace
}  // namespace lumitexel
