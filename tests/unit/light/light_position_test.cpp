#include "processing/calibration/light/light_position.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "drivers/error.h"

namespace lumitexel {
namespace {

CameraModel test_camera() { return {1024, 768, 2950, 2950, 516.3, 379.8, -0.08, 0.15, 0.0004, -0.0003}; }

constexpr double kRadius_m = 0.02, kSpacing_m = 0.05;

SphereLine test_line(const Eigen::Vector3d& direction = {0.98, 0.03, 0.2}) {
  SphereLine line;
  line.direction = direction.normalized();
  line.first_centre = Eigen::Vector3d(0.0, -0.09, 1.05) - 2.5 * kSpacing_m * line.direction;
  line.spacing_m = kSpacing_m;
  line.radius_m = kRadius_m;
  line.count = 6;
  return line;
}

// Fermat: light takes the shortest way over the sphere's facing side. Found by shrinking a pattern search over the
// sphere, which shares nothing with the code under test.
Eigen::Vector3d shortest_way_point(const MirrorSphere& sphere, const Eigen::Vector3d& eye,
                                   const Eigen::Vector3d& light) {
  Eigen::Vector3d normal = ((eye - sphere.centre).normalized() + (light - sphere.centre).normalized()).normalized();
  const auto length = [&](const Eigen::Vector3d& n) {
    const Eigen::Vector3d x = sphere.centre + sphere.radius_m * n;
    return (x - eye).norm() + (x - light).norm();
  };
  for (double step = 0.1; step > 1e-9;) {
    const Eigen::Vector3d across = normal.unitOrthogonal(), other = normal.cross(across);
    Eigen::Vector3d best = normal;
    for (const Eigen::Vector3d& move : {across, other, Eigen::Vector3d(-across), Eigen::Vector3d(-other)}) {
      const Eigen::Vector3d candidate = (normal + step * move).normalized();
      if (length(candidate) < length(best)) best = candidate;
    }
    if (best == normal) step *= 0.5;
    normal = best;
  }
  return sphere.centre + sphere.radius_m * normal;
}

const std::vector<Eigen::Vector3d> kLights{{0.8, -0.5, 0.6}, {-0.9, -0.3, 0.4}, {0.1, -1.0, 0.5}, {0.3, -0.4, -0.2}};

TEST(SphereReflection, MirrorPointIsTheShortestWay) {
  for (const Eigen::Vector3d& light : kLights) {
    for (int k = 0; k < 6; ++k) {
      const MirrorSphere sphere = test_line().sphere(k);
      const Eigen::Vector3d expected = shortest_way_point(sphere, Eigen::Vector3d::Zero(), light);
      // A shortest length is flat: to double precision it fixes its place to about sqrt(1e-16).
      EXPECT_LT((mirror_point(sphere, Eigen::Vector3d::Zero(), light) - expected).norm(), 1e-8);
    }
  }
}

TEST(SphereReflection, TheMirroredRayThroughTheMirrorPointMeetsTheLight) {
  const MirrorSphere sphere = test_line().sphere(2);
  for (const Eigen::Vector3d& light : kLights) {
    const Eigen::Vector3d point = mirror_point(sphere, Eigen::Vector3d::Zero(), light);
    const auto ray = mirrored_ray(sphere, {Eigen::Vector3d::Zero(), point.normalized()});
    ASSERT_TRUE(ray);
    EXPECT_LT((light - ray->origin).cross(ray->direction).norm(), 1e-9);
    EXPECT_GT((light - ray->origin).dot(ray->direction), 0.0);
  }
  EXPECT_FALSE(mirrored_ray(sphere, {Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 1, 0)}));
}

class LineDirections : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(LineDirections, AreRecoveredExactlyFromExactRays) {
  const SphereLine truth = test_line(GetParam());
  std::vector<Eigen::Vector3d> rays;
  for (int k = 0; k < 6; ++k) rays.push_back(truth.sphere(k).centre.normalized());
  const SphereLine line = sphere_line_from_rays(rays, kSpacing_m, kRadius_m);
  for (int k = 0; k < 6; ++k) {
    // Rounding of 1e-16, magnified by depth over the picture's spacing, at most some 1e4.
    EXPECT_LT((line.sphere(k).centre - truth.sphere(k).centre).norm(), 1e-10) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(SphereLine, LineDirections,
                         testing::Values(Eigen::Vector3d(1, 0, 0),  // parallel to the image and its rows
                                         Eigen::Vector3d(0, 1, 0),  // and its columns
                                         Eigen::Vector3d(1, 1, 0),  // parallel to the image, oblique
                                         Eigen::Vector3d(0.98, 0.03, 0.2),
                                         Eigen::Vector3d(0.1, 0.3, -1)));  // almost in depth

TEST(SphereLine, IsRecoveredExactlyWithSpheresMissing) {
  const SphereLine truth = test_line();
  for (const std::vector<int>& places : {std::vector{0, 1, 3, 5}, std::vector{0, 2, 3}, std::vector{1, 4, 5}}) {
    std::vector<Eigen::Vector3d> rays;
    for (const int k : places) rays.push_back(truth.sphere(k).centre.normalized());
    const SphereLine line = sphere_line_from_rays(rays, places, kSpacing_m, kRadius_m);
    EXPECT_EQ(line.count, places.back() + 1);
    for (int k = 0; k < 6; ++k) EXPECT_LT((line.sphere(k).centre - truth.sphere(k).centre).norm(), 1e-10) << k;
  }
  const std::vector<Eigen::Vector3d> rays(3, Eigen::Vector3d::UnitZ());
  EXPECT_THROW(sphere_line_from_rays(rays, {0, 2, 2}, kSpacing_m, kRadius_m), BadInput);
  EXPECT_THROW(sphere_line_from_rays(rays, {0, 1}, kSpacing_m, kRadius_m), BadInput);
}

TEST(SphereLine, RefusesWhatIsNoLine) {
  EXPECT_THROW(sphere_line_from_rays({Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()}, 0.05, 0.02), BadInput);
  EXPECT_THROW(sphere_line_from_rays(std::vector<Eigen::Vector3d>(6, Eigen::Vector3d::UnitZ()), 0.05, 0.02), BadInput);
}

constexpr double kRing_m = 0.04;

Eigen::Vector2d true_pixel(const MirrorSphere& sphere, const Eigen::Vector3d& light) {
  return test_camera().project(shortest_way_point(sphere, Eigen::Vector3d::Zero(), light));
}

struct Observed {
  std::vector<HighlightPixel> rings;
  std::vector<std::vector<HighlightPixel>> points;
};

// Highlights from the shortest ways, the ring's centroid from 64 emitters; computed once, the pattern search is slow.
const Observed& exact_highlights() {
  static const Observed observed = [] {
    Observed o;
    for (int k = 0; k < 6; ++k) {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      double light = 0.0;
      for (int e = 0; e < 64; ++e) {
        const double angle = 2.0 * M_PI * e / 64.0;
        const Eigen::Vector3d emitter(kRing_m * std::cos(angle), kRing_m * std::sin(angle), 0.0);
        const double share = 1.0 / (shortest_way_point(test_line().sphere(k), Eigen::Vector3d::Zero(), emitter) - emitter).squaredNorm();
        sum += share * true_pixel(test_line().sphere(k), emitter);
        light += share;
      }
      o.rings.push_back({k, sum / light, 0.05});
    }
    for (const Eigen::Vector3d& light : kLights) {
      o.points.emplace_back();
      for (int k = 0; k < 6; ++k) o.points.back().push_back({k, true_pixel(test_line().sphere(k), light), 0.05});
    }
    return o;
  }();
  return observed;
}

SphereLine first_guess(const std::vector<HighlightPixel>& rings) {
  std::vector<Eigen::Vector3d> rays;
  for (const HighlightPixel& ring : rings) rays.push_back(test_camera().unproject(ring.pixel));
  return sphere_line_from_rays(rays, kSpacing_m, kRadius_m);
}

LightSolution solved(const Observed& o) {
  return solve_lights(test_camera(), first_guess(o.rings), kRing_m, o.rings, o.points);
}

TEST(RingHighlight, PointsAtTheCentreUpToSecondOrder) {
  for (const HighlightPixel& ring : exact_highlights().rings) {
    const MirrorSphere sphere = test_line().sphere(ring.sphere);
    const double off_px = (ring.pixel - test_camera().project(sphere.centre)).norm();
    EXPECT_GT(off_px, 1e-6);  // second order is not nothing
    EXPECT_LT(off_px, 0.02);  // but small
    EXPECT_LT((ring_highlight_pixel(test_camera(), sphere, kRing_m) - ring.pixel).norm(), 1e-4);
  }
}

TEST(LightPosition, IsExactFromExactHighlights) {
  const LightSolution solution = solved(exact_highlights());
  EXPECT_TRUE(solution.converged);
  for (std::size_t v = 0; v < kLights.size(); ++v) {
    ASSERT_TRUE(solution.lights[v].measured);
    // The truth's pixels are good to 1e-4 px (ring: eight emitters for many); a light's distance moves by about
    // 0.15 m per pixel: 15 micrometres, and twice that.
    EXPECT_LT((solution.lights[v].position - kLights[v]).norm(), 3e-5) << v;
    EXPECT_EQ(solution.lights[v].outliers, 0);
  }
  EXPECT_LT((solution.line.sphere(5).centre - test_line().sphere(5).centre).norm(), 1e-5);
}

TEST(LightPosition, ErrorsAreWhatTheCovarianceSays) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  constexpr int kTrials = 60;
  double mahalanobis2 = 0.0;
  int count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Observed o = exact_highlights();
    for (HighlightPixel& ring : o.rings) ring.pixel += Eigen::Vector2d(noise(random), noise(random));
    for (auto& view : o.points) {
      for (HighlightPixel& point : view) point.pixel += Eigen::Vector2d(noise(random), noise(random));
    }
    const LightSolution solution = solved(o);
    for (std::size_t v = 0; v < kLights.size(); ++v) {
      const Eigen::Vector3d error = solution.lights[v].position - kLights[v];
      mahalanobis2 += error.dot(solution.lights[v].covariance.inverse() * error);
      ++count;
    }
  }
  // Expectation 3; the sum over 240 lights (correlated in fours through the line) deviates by some 3 * 8 %; the scale
  // of at least one and the heavy-tailed loss shift it by a little. Wrong covariances are wrong by factors.
  EXPECT_NEAR(mahalanobis2 / count, 3.0, 1.0);
}

TEST(LightPosition, AFalseHighlightIsFoundOutAndDoesNoHarm) {
  Observed o = exact_highlights();
  o.points[1][4].pixel += Eigen::Vector2d(9.0, -6.0);
  const LightSolution solution = solved(o);
  EXPECT_EQ(solution.lights[1].outliers, 1);
  EXPECT_LT((solution.lights[1].position - kLights[1]).norm(), 1e-3);
  EXPECT_LT((solution.lights[0].position - kLights[0]).norm(), 1e-3);
}

TEST(LightPosition, TooFewHighlightsAreNotMeasured) {
  Observed o = exact_highlights();
  o.points[2].resize(2);
  o.points[3].clear();
  const LightSolution solution = solved(o);
  EXPECT_TRUE(solution.lights[0].measured);
  EXPECT_FALSE(solution.lights[2].measured);
  EXPECT_FALSE(solution.lights[3].measured);
  const SphereLine line = first_guess(o.rings);
  o.rings.resize(2);
  EXPECT_THROW(solve_lights(test_camera(), line, kRing_m, o.rings, o.points), BadInput);
}

}  // namespace
}  // namespace lumitexel
