#include "processing/calibration/light/point_highlights.h"
#include "processing/calibration/light/sphere_row.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lumitexel {
namespace {

constexpr double kBalance[3] = {0.6, 1.0, 0.8};

struct Spot {
  Eigen::Vector2d pixel;
  double amplitude, width_px;
};

// Spots of Gaussian profile (not the fitted one) on a mosaic, integrated over the pixels by their exact integral, with
// noise.
MosaicRadiance picture(Mosaic mosaic, const std::vector<Spot>& spots, std::uint64_t seed, int width = 400,
                       int height = 300) {
  MosaicRadiance m;
  m.width = width;
  m.height = height;
  m.mosaic = mosaic;
  m.value.assign(static_cast<std::size_t>(width * height), 0.0f);
  m.variance.assign(m.value.size(), 9.0f);
  m.flags.assign(m.value.size(), 0);
  const auto part = [](double x, double centre, double sigma) {
    return 0.5 * (std::erf((x + 1 - centre) / (sigma * M_SQRT2)) - std::erf((x - centre) / (sigma * M_SQRT2)));
  };
  for (const Spot& spot : spots) {
    const double flux = spot.amplitude * 2.0 * M_PI * spot.width_px * spot.width_px;
    for (int y = std::max(0, static_cast<int>(spot.pixel.y()) - 20);
         y < std::min(height, static_cast<int>(spot.pixel.y()) + 20); ++y) {
      for (int x = std::max(0, static_cast<int>(spot.pixel.x()) - 20);
           x < std::min(width, static_cast<int>(spot.pixel.x()) + 20); ++x) {
        const double gain = mosaic == Mosaic::Mono ? 1.0 : kBalance[mosaic_channel(mosaic, x, y)];
        m.value[m.index(x, y)] += static_cast<float>(gain * flux * part(x, spot.pixel.x(), spot.width_px) *
                                                     part(y, spot.pixel.y(), spot.width_px));
      }
    }
  }
  std::mt19937_64 random(seed);
  std::normal_distribution<float> noise(0.0f, 1.0f);
  for (std::size_t i = 0; i < m.value.size(); ++i) {
    m.variance[i] = 9.0f + m.value[i];
    m.value[i] += std::sqrt(m.variance[i]) * noise(random);
  }
  return m;
}

double rms_error_px(Mosaic mosaic, const std::optional<ColourBalance>& balance, double width_px) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> within(0.0, 2.0);
  double sum = 0.0;
  constexpr int kTrials = 30;
  for (int i = 0; i < kTrials; ++i) {
    const Eigen::Vector2d truth(20.0 + within(random), 20.0 + within(random));
    const MosaicRadiance image = picture(mosaic, {{truth, 8000.0, width_px}}, static_cast<std::uint64_t>(i), 40, 40);
    const auto fit = fit_highlight(image, truth + Eigen::Vector2d(0.4, -0.3), 8, balance);
    EXPECT_TRUE(fit) << i;
    if (fit) sum += (fit->pixel - truth).squaredNorm() / (2.0 * kTrials);
  }
  return std::sqrt(sum);
}

// The profile fitted is not the spot's own: what is left is that mismatch, a few hundredths of a pixel.
TEST(HighlightFit, FindsTheCentreToHundredthsOfAPixel) {
  EXPECT_LT(rms_error_px(Mosaic::Mono, std::nullopt, 0.9), 0.01);
  EXPECT_LT(rms_error_px(Mosaic::Rggb, ColourBalance{0.6, 1.0, 0.8}, 0.9), 0.03);
  EXPECT_LT(rms_error_px(Mosaic::Rggb, std::nullopt, 1.3), 0.03);
}

TEST(HighlightFit, MeasuresTheColourBalance) {
  const auto fit =
      fit_highlight(picture(Mosaic::Rggb, {{{20.3, 19.6}, 8000.0, 1.3}}, 1, 40, 40), {20, 20}, 8, std::nullopt);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->balance[0], 0.6, 0.03);
  EXPECT_NEAR(fit->balance[2], 0.8, 0.03);
}

TEST(HighlightFit, AClippedCoreIsFoundByItsFlanks) {
  MosaicRadiance image = picture(Mosaic::Mono, {{{20.3, 19.6}, 8000.0, 1.3}}, 1, 40, 40);
  for (std::size_t i = 0; i < image.value.size(); ++i) {
    if (image.value[i] > 4000.0f) {
      image.value[i] = 4000.0f;
      image.flags[i] = kPixelSaturated;
    }
  }
  const auto fit = fit_highlight(image, {20, 20}, 8, std::nullopt);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->pixel - Eigen::Vector2d(20.3, 19.6)).norm(), 0.06);
}

TEST(HighlightFit, SaysNoWhereNothingIs) {
  MosaicRadiance image = picture(Mosaic::Rggb, {}, 1, 40, 40);
  const auto fit = fit_highlight(image, {20, 20}, 8, ColourBalance{0.6, 1.0, 0.8});
  EXPECT_TRUE(!fit || fit->sigma_px > 0.1);
  for (std::uint8_t& flag : image.flags) flag = kPixelSaturated;
  EXPECT_FALSE(fit_highlight(image, {20, 20}, 8, ColourBalance{0.6, 1.0, 0.8}));
}

CameraModel camera() { return {400, 300, 1100, 1100, 203.0, 148.0, -0.08, 0.1, 0, 0}; }

SphereLine line() {
  SphereLine l;
  l.direction = Eigen::Vector3d(0.95, 0.1, 0.3).normalized();
  l.first_centre = {-0.13, -0.1, 1.0};
  l.spacing_m = 0.05;
  l.radius_m = 0.02;
  l.count = 6;
  return l;
}

// A rough mirror sphere under a light: D of the true half vector in every place of every pixel, Gaussian in its tangent
// (not the fitted profile), over the microfacet model's cosine. No noise: what is left is the model's own error.
MosaicRadiance rough_sphere(const MirrorSphere& sphere, const CameraModel& seen_by, const Eigen::Vector3d& light) {
  MosaicRadiance m;
  m.width = seen_by.width_px;
  m.height = seen_by.height_px;
  constexpr int kSub = 6;
  constexpr double kRoughness = 0.025;
  for (int y = 0; y < m.height; ++y) {
    for (int x = 0; x < m.width; ++x) {
      double sum = 0.0;
      for (int s = 0; s < kSub * kSub; ++s) {
        const Eigen::Vector3d view = seen_by.unproject({x + (s % kSub + 0.5) / kSub, y + (s / kSub + 0.5) / kSub});
        const auto hit = mirrored_ray(sphere, {Eigen::Vector3d::Zero(), view});
        if (!hit) continue;
        const Eigen::Vector3d normal = (hit->origin - sphere.centre).normalized();
        const Eigen::Vector3d half = ((light - hit->origin).normalized() - view).normalized();
        const double tan2 = 1.0 / std::pow(normal.dot(half), 2) - 1.0;
        sum += std::exp(-tan2 / (kRoughness * kRoughness)) / -normal.dot(view);
      }
      m.value.push_back(static_cast<float>(1e4 * sum / (kSub * kSub)));
    }
  }
  m.variance.assign(m.value.size(), 1.0f);
  m.flags.assign(m.value.size(), 0);
  return m;
}

TEST(HighlightFit, OnAKnownSphereFollowsTheMirrorPoint) {
  const CameraModel seen_by{240, 240, 2950, 2950, 120, 120, 0, 0, 0, 0};
  const MirrorSphere sphere{{0.001, 0.002, 1.0}, 0.02};
  const Eigen::Vector3d light(0.8, 0.2, 0.35);  // well to the side: the highlight lies half way to the rim
  const MosaicRadiance image = rough_sphere(sphere, seen_by, light);
  const Eigen::Vector2d truth = highlight_pixel(seen_by, sphere, light);
  const auto plain = fit_highlight(image, truth, 8, std::nullopt);
  const auto on_sphere = fit_highlight(image, truth, 8, std::nullopt, {SphereInView{seen_by, sphere}, {}});
  ASSERT_TRUE(plain && on_sphere);
  EXPECT_GT((plain->pixel - truth).norm(), 0.004);  // the inward pull that the picture's plane cannot know
  EXPECT_LT((on_sphere->pixel - truth).norm(), 0.002);
}

std::vector<Spot> row_and_sparkles(std::uint64_t seed) {
  std::vector<Spot> spots;
  for (int k = 0; k < 6; ++k) spots.push_back({camera().project(line().sphere(k).centre), 5000.0, 1.0});
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> x(60.0, 340.0), y(90.0, 280.0), amplitude(500.0, 20'000.0);
  for (int i = 0; i < 60; ++i) spots.push_back({{x(random), y(random)}, amplitude(random), 1.0});
  return spots;
}

TEST(SphereRow, IsFoundAmongTheObjectsSparkles) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto row =
        find_sphere_row(compact_blobs(picture(Mosaic::Rggb, row_and_sparkles(seed), seed), 80), camera(), 6);
    ASSERT_TRUE(row) << seed;
    for (int k = 0; k < 6; ++k) {
      EXPECT_LT(((*row)[static_cast<std::size_t>(k)].pixel - camera().project(line().sphere(k).centre)).norm(), 1.0)
          << seed << ' ' << k;
    }
  }
}

TEST(SphereRow, IsNotInventedWhereASphereIsMissing) {
  std::vector<Spot> spots;
  for (int k = 0; k < 5; ++k) spots.push_back({camera().project(line().sphere(k).centre), 5000.0, 1.0});
  EXPECT_FALSE(find_sphere_row(compact_blobs(picture(Mosaic::Rggb, spots, 1), 80), camera(), 6));
}

// One or two of six hidden, alone and among sparkles: the row is among those found, at its places.
TEST(SphereRow, WithGapsIsFoundAtItsPlaces) {
  const auto is_the_row = [](const PartialRow& row, const std::vector<int>& places) {
    if (row.members.size() != places.size()) return false;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& [place, blob] = row.members[i];
      if (place != places[i] - places[0]) return false;
      if (!((blob.pixel - camera().project(line().sphere(places[i]).centre)).norm() < 1.0)) return false;
    }
    return true;
  };
  for (const std::vector<int>& places : {std::vector{0, 1, 3, 5}, std::vector{1, 2, 3, 4}, std::vector{0, 2, 3, 4, 5}}) {
    std::vector<Spot> spots;
    for (const int k : places) spots.push_back({camera().project(line().sphere(k).centre), 5000.0, 1.0});
    const auto alone = find_partial_rows(compact_blobs(picture(Mosaic::Rggb, spots, 1), 80), camera(), 6, 12);
    ASSERT_FALSE(alone.empty());
    const auto wanted = [&](const PartialRow& row) { return is_the_row(row, places); };
    EXPECT_TRUE(std::any_of(alone.begin(), alone.end(), wanted));
    EXPECT_EQ(alone[0].members.size(), places.size());
    const std::vector<Spot> sparkles = row_and_sparkles(1);
    spots.insert(spots.end(), sparkles.begin() + 6, sparkles.begin() + 26);
    const auto rows = find_partial_rows(compact_blobs(picture(Mosaic::Rggb, spots, 1), 80), camera(), 6, 1000);
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), wanted));
  }
  EXPECT_EQ(least_of_row(6), 4);
  EXPECT_EQ(least_of_row(9), 5);
}

// Of a steep line, four that look like four others of one with the opposite slope.
TEST(SphereRow, WhoseGapsReadTwoWaysIsLeftOut) {
  SphereLine steep = line();
  steep.first_centre = {-0.05, -0.03, 0.35};
  steep.direction = Eigen::Vector3d(0.4, 0.1, 0.9).normalized();
  for (const std::vector<int>& places : {std::vector{0, 1, 3, 5}, std::vector{0, 1, 2, 3, 5}}) {
    std::vector<Spot> spots;
    for (const int k : places) spots.push_back({camera().project(steep.sphere(k).centre), 5000.0, 1.0});
    const auto rows = find_partial_rows(compact_blobs(picture(Mosaic::Rggb, spots, 1), 80), camera(), 6, 12);
    const bool found = std::any_of(rows.begin(), rows.end(), [&](const PartialRow& row) { return row.members.size() == places.size(); });
    EXPECT_EQ(found, places.size() == 5);
  }
}

TEST(CompactBlobs, LeaveBroadThingsOut) {
  const auto blobs =
      compact_blobs(picture(Mosaic::Mono, {{{100, 100}, 5000.0, 1.2}, {{250, 150}, 5000.0, 15.0}}, 1), 80);
  ASSERT_EQ(blobs.size(), 1u);
  EXPECT_LT((blobs[0].pixel - Eigen::Vector2d(100, 100)).norm(), 0.5);
}

TEST(PointHighlights, BelongToTheirSpheresTheBrightestFirst) {
  const Eigen::Vector3d light(0.6, -0.5, 0.3);
  std::vector<Spot> spots;
  for (const int k : {0, 2, 3, 5}) {
    spots.push_back({highlight_pixel(camera(), line().sphere(k), light), 6000.0, 1.0});
    // A neighbour's reflection on the other side of the disc, dimmer.
    spots.push_back({camera().project(line().sphere(k).centre) + Eigen::Vector2d(-14, 6), 1500.0, 1.0});
  }
  spots.push_back({{200, 220}, 20'000.0, 1.0});  // the object's own
  const auto found = find_point_highlights(compact_blobs(picture(Mosaic::Rggb, spots, 3), 100), camera(), line());
  ASSERT_EQ(found.size(), 8u);  // each sphere's own, then the reflection
  SeenInView seen;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto& [sphere, blob] = found[i];
    const bool own = (blob.pixel - highlight_pixel(camera(), line().sphere(sphere), light)).norm() < 1.0;
    EXPECT_EQ(own, i % 2 == 0) << sphere;
    seen.push_back({sphere, blob, FittedHighlight{.pixel = blob.pixel, .sigma_px = 0.05}});
  }
  // No light explains the reflections of neighbours, which are left out.
  const SortedHighlights sorted = sort_highlights(camera(), line(), seen, light + Eigen::Vector3d(0.03, 0.0, 0.02), 0.25);
  ASSERT_EQ(sorted.own.size(), 4u);
  EXPECT_TRUE(sorted.strays.empty());
  for (const SeenHighlight& highlight : sorted.own) {
    EXPECT_LT((highlight.blob.pixel - highlight_pixel(camera(), line().sphere(highlight.sphere), light)).norm(), 1.0);
  }
}

}  // namespace
}  // namespace lumitexel
