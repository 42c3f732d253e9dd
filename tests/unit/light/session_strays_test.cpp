// Stray lights of a session, and what they do to the sigmas of scale and lamp.
#include "processing/calibration/session_strays.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "processing/calibration/session_lamp.h"
#include "tests/unit/light/light_bench.h"

namespace lumitexel {
namespace {

constexpr double kFarHighlight_px = 0.02;

// The bench with a second light: exact highlights whose light goes with the intensity over the squared distance.
class StraySession {
 public:
  explicit StraySession(std::vector<std::pair<std::size_t, Eigen::Vector3d>> strays, double strength = 0.5) : bench_(bench_at({0, 0, 0})) {
    bench_.rig.camera.limits.mosaic = Mosaic::Rggb;
    const RigHighlights own = noisy_highlights(bench_.spheres, 0.0, 1);
    seen_ = {own.rings, own.points, std::vector<std::vector<std::vector<HighlightPixel>>>(own.points.size()), bench_.spheres.line};
    for (std::size_t v = 0; v < own.points.size(); ++v) give_flux(seen_.points[v], bench_.spheres.lights[v], 1.0);
    for (const auto& [view, light] : strays) {
      std::vector<HighlightPixel>& highlights = seen_.strays[view].emplace_back();
      for (int k = 0; k < bench_.spheres.line.count; ++k) {
        highlights.push_back({k, highlight_pixel(bench_.spheres.camera, bench_.spheres.line.sphere(k), light), kFarHighlight_px});
      }
      give_flux(highlights, light, strength);
    }
  }

  SessionStrays strays() const { return {seen_, lights(), bench_.spheres.camera, bench_.rig}; }
  SessionLights lights() const {
    return align_lights(solved_lights(bench_.spheres, {seen_.rings, seen_.points}), bench_.views, bench_.plan, bench_.rig,
                        bench_.rig.camera.camera_from_rig);
  }
  void forget_lamp() {
    for (auto& view : seen_.points) {
      for (HighlightPixel& point : view) point.flux = {};
    }
  }
  const LightBench& bench() const { return bench_; }
  const Eigen::Vector3d& lamp(std::size_t v) const { return bench_.spheres.lights[v]; }

 private:
  void give_flux(std::vector<HighlightPixel>& highlights, const Eigen::Vector3d& light, double strength) const {
    for (HighlightPixel& seen : highlights) {
      const MirrorSphere sphere = bench_.spheres.line.sphere(seen.sphere);
      const double reflectance = 1.0 + 0.1 * seen.sphere;  // cancels
      const double square = (light - mirror_point(sphere, Eigen::Vector3d::Zero(), light)).squaredNorm();
      for (double& flux : seen.flux) flux = reflectance * strength / square;
    }
  }

  LightBench bench_;
  SphereHighlights seen_;
};

// 20 cm beside the spheres' middle, facing the camera's side.
const LitPlace kCard{{-0.1, 0.1, 1.0}, -Eigen::Vector3d::UnitZ()};
const Eigen::Vector3d kStray(0.7, -0.6, 0.1);

double irradiance(const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_light = light - kCard.position;
  return to_light.dot(kCard.normal) / std::pow(to_light.norm(), 3);
}
double share_of(const Eigen::Vector3d& stray, const Eigen::Vector3d& lamp, double strength) {
  return strength * irradiance(stray) / irradiance(lamp);
}

// The upper end of one sigma: the common error of 2 % makes 1.0002 of it, the position next to nothing.
constexpr double kUpperEnd = 1e-3;

TEST(SessionStrays, WithoutAnyHaveNoShares) {
  const SessionStrays none = StraySession({}).strays();
  EXPECT_FALSE(none.any());
  EXPECT_TRUE(none.shares(kCard, {0, 0, 0}).empty());
}

TEST(SessionStrays, OneThatStandsCountsInEveryView) {
  const StraySession session({{0, kStray}, {2, kStray}});
  const SessionStrays strays = session.strays();
  for (std::size_t v = 0; v < 4; ++v) {
    const std::vector<double> shares = strays.shares(kCard, session.lamp(v), v);
    ASSERT_EQ(shares.size(), 3u);
    for (const double share : shares) EXPECT_NEAR(share / share_of(kStray, session.lamp(v), 0.5), 1.0, kUpperEnd) << v;
  }
}

TEST(SessionStrays, OneOfASingleViewCountsThereAndUnderALampNearIt) {
  const StraySession session({{1, kStray}});
  const SessionStrays strays = session.strays();
  EXPECT_EQ(strays.shares(kCard, session.lamp(0), 0)[0], 0.0);
  EXPECT_GT(strays.shares(kCard, session.lamp(1), 1)[0], 0.1);
  EXPECT_GT(strays.shares(kCard, session.lamp(1) + Eigen::Vector3d(0.01, 0.01, 0.0))[0], 0.1);
  EXPECT_EQ(strays.shares(kCard, session.lamp(0))[0], 0.0);
  EXPECT_TRUE(strays.summarise({"a", "b", "c", "d"}, kCard, session.lamp(1))[0].counted_in_scale);
  EXPECT_FALSE(strays.summarise({"a", "b", "c", "d"}, kCard, session.lamp(0))[0].counted_in_scale);
}

// Its distance the spheres cannot tell, its irradiance they can: the same on card and spheres.
TEST(SessionStrays, OneFarAwayIsReportedByItsDirection) {
  const Eigen::Vector3d far = 400.0 * Eigen::Vector3d(0.6, -0.5, -0.3).normalized();
  const double strength = 0.4 * far.squaredNorm();
  const StraySession session({{0, far}, {3, far}}, strength);
  const std::vector<StrayLightSummary> found =
      session.strays().summarise({"a", "b", "c", "d"}, kCard, session.lamp(0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].placed);
  EXPECT_EQ(found[0].views, (std::vector<std::string>{"a", "d"}));
  EXPECT_LT((found[0].position_in_rig - far.normalized()).norm(), 0.01);
  const double truth = share_of(far, session.lamp(0), strength);
  EXPECT_NEAR(*found[0].card_share, truth, 0.02 * truth);
  EXPECT_LT(std::abs(*found[0].card_share - truth), *found[0].card_share_sigma);
}

TEST(SessionStrays, OneOfUnknownStrengthCountsAsMuchAsTheLamp) {
  StraySession session({{0, kStray}, {2, kStray}});
  session.forget_lamp();
  const SessionStrays strays = session.strays();
  EXPECT_EQ(strays.shares(kCard, session.lamp(0), 0), std::vector<double>(3, 1.0));
  EXPECT_FALSE(strays.summarise({"a", "b", "c", "d"}, kCard, session.lamp(0))[0].card_share);
}

// At a metre in one view, where the other cannot tell its distance: one light, which stands, with its place.
TEST(SessionStrays, OneThatIsPlacedInSomeViewsOnlyIsOne) {
  const SphereLine line = StraySession({}).bench().spheres.line;
  const Eigen::Vector3d middle = 0.5 * (line.sphere(0).centre + line.sphere(5).centre), far = middle + 400.0 * (kStray - middle);
  for (const auto& [first, second] : {std::pair{kStray, far}, std::pair{far, kStray}}) {
    const StraySession session({{0, first}, {2, second}});
    const std::vector<StrayLightSummary> found = session.strays().summarise({"a", "b", "c", "d"}, kCard, session.lamp(0));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].placed);
    EXPECT_EQ(found[0].views.size(), 2u);
    EXPECT_LT((found[0].position_in_rig - kStray).norm(), 0.05);
  }
}

TEST(SessionStrays, OnACardThatFacesAwayFromTheLampIsNotKnown) {
  const StraySession session({{0, kStray}, {2, kStray}});
  const LitPlace away{kCard.position, Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(session.strays().shares(away, session.lamp(0), 0), std::vector<double>(3, 1.0));
}

TimedReading reading_at(double time_s, const Eigen::Vector3d& lamp, double intensity, double share) {
  TimedReading timed{time_s, lamp, CardReading{}, {}};
  timed.reading->intensity = {1.1 * intensity * (1.0 + share), intensity * (1.0 + share), 0.8 * intensity * (1.0 + share)};
  timed.reading->pixel_scatter = {0.01, 0.01, 0.01};
  timed.reading->pixel_sigma = timed.reading->light_sigma = timed.reading->pose_sigma = 1e-3;
  timed.reading->card_in_rig = kCard.position;
  if (share > 0.0) timed.stray_shares.assign(3, share);
  return timed;
}

struct Lamp {
  SessionLamp lamp;
  CalibrationSummary summary;
};
// Eight readings of a steady lamp of intensity 10 and the bracket's; shares of the views, then of the bracket.
Lamp lamp_under(const std::vector<double>& shares) {
  const StraySession session({});
  CapturedInputs in;
  in.rig = session.bench().rig;
  std::vector<TimedReading> views;
  for (std::size_t v = 0; v + 1 < shares.size(); ++v) views.push_back(reading_at(60.0 * static_cast<double>(v), session.lamp(v % 4), 10.0, shares[v]));
  Lamp result;
  result.lamp = measure_lamp(in, session.lights(), {}, views, reading_at(500.0, session.lamp(0), 10.0, shares.back()), {}, result.summary);
  return result;
}

double share_of_strays(const CalibrationSummary& summary) {
  for (const UncertaintyShare& share : summary.shares) {
    if (share.quantity == "scale" && share.source == "stray lights") return share.share;
  }
  return 0.0;
}

TEST(StrayLightsInTheScale, WidenItsSigmaByAllTheyAdd) {
  const Lamp clear = lamp_under(std::vector<double>(9, 0.0)), spoilt = lamp_under(std::vector<double>(9, 0.69));
  EXPECT_LT(clear.summary.scale_sigma, 0.003);
  EXPECT_EQ(share_of_strays(clear.summary), 0.0);
  EXPECT_NEAR(clear.summary.intensity[1], 10.0, 1e-6);
  EXPECT_NEAR(spoilt.summary.intensity[1], 16.9, 1e-6);  // nothing is corrected
  EXPECT_NEAR(spoilt.summary.scale_sigma, 0.69, 0.001);
  EXPECT_EQ(spoilt.summary.scale_sigma, spoilt.lamp.scale_sigma);
  EXPECT_GT(share_of_strays(spoilt.summary), 0.99);
}

// The lamp's factors are all one; what the readings say instead must be within twice what is stated.
TEST(StrayLightsInTheLamp, ThatComeAndGoAreInItsFactorsSigmas) {
  const Lamp spoilt = lamp_under({0.0, 0.02, 0.05, 0.09, 0.14, 0.2, 0.27, 0.35, 0.4});
  EXPECT_TRUE(spoilt.summary.lamp.drifts);
  EXPECT_LT(spoilt.summary.lamp.factor[0], 0.8);
  for (std::size_t v = 0; v < 8; ++v) {
    EXPECT_LT(std::abs(spoilt.summary.lamp.factor[v] - 1.0), 2.0 * spoilt.summary.lamp.factor_sigma[v]) << v;
  }
}

}  // namespace
}  // namespace lumitexel
