// The simulated sensor warms by 5 K between its darks and the frame of a scene with gradients and edges.
#include "processing/image/dark_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "drivers/error.h"
#include "processing/image/hdr_merge.h"
#include "sim/sensor.h"

namespace lumitexel {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kDark_c = 25.0, kExposure_s = 0.256;

CameraDescription camera() {
  CameraDescription camera;
  camera.limits = {.width_px = kWidth, .height_px = kHeight, .bits = 14, .mosaic = Mosaic::Rggb};
  camera.sensor = {.electrons_per_dn = 1.2, .full_well_e = 18000.0, .read_noise_e = 4.0, .black_level_dn = 256.0};
  return camera;
}

SimulationSettings settings_at(double temperature_c, std::uint64_t seed) {
  SimulationSettings settings;
  settings.seed = seed;
  settings.sensor_temperature_c = temperature_c;
  settings.hot_pixel_fraction = 2e-3;  // 150 of this small picture, as 12 Mpixel have at 1e-5
  return settings;
}

// A gradient, a checkerboard's edges and a third of darkness.
Image scene() {
  Image radiance(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool white = ((x / 17 + y / 23) & 1) != 0;
      for (int c = 0; c < 3; ++c)
        radiance.at(x, y, c) = x < kWidth / 3 ? 0.0f : 0.0003f * static_cast<float>(y) * (white ? 1.0f : 0.2f);
    }
  }
  return radiance;
}

Frame shot(const Image& radiance, double temperature_c, std::uint64_t seed, std::uint64_t noise_key) {
  Frame frame;
  frame.width_px = kWidth;
  frame.height_px = kHeight;
  frame.bits = 14;
  frame.mosaic = Mosaic::Rggb;
  frame.reported.exposure_s = kExposure_s;
  frame.sensor_temperature_c = temperature_c;
  frame.samples = SimulatedSensor(camera(), settings_at(temperature_c, seed)).expose(radiance, frame.reported, noise_key);
  return frame;
}

MasterDark dark(std::uint64_t seed) {
  const Image black(kWidth, kHeight, 3);
  std::vector<Frame> frames;
  for (std::uint64_t i = 0; i < 4; ++i) frames.push_back(shot(black, kDark_c, seed, 1000 * seed + i));
  return make_master_dark(frames, linear_sensor(camera(), 0.0));
}

struct Trial {
  DarkScale fitted;
  double plain_square = 0, scaled_square = 0;  // mean square error of the expectation on hot and warm pixels, DN^2
};

Trial trial(double warmer_k, std::uint64_t seed, const Image& radiance) {
  const LinearSensor sensor = linear_sensor(camera(), 0.0);
  const MasterDark master = dark(seed);
  const Frame frame = shot(radiance, kDark_c + warmer_k, seed, 1000 * seed + 500);
  Trial result{fit_dark_scale({{&frame, &master}}, sensor), 0, 0};
  const MasterDark scaled = scaled_dark(master, result.fitted, sensor);
  const SimulatedSensor warm(camera(), settings_at(kDark_c + warmer_k, seed));
  double n = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double truth = 256.0 + warm.dark_current_e_per_s(x, y) * kExposure_s / 1.2;
      if (!warm.is_hot(x, y)) continue;
      const auto i = static_cast<std::size_t>(y * kWidth + x);
      result.plain_square += std::pow(master.mean_dn[i] - truth, 2);
      result.scaled_square += std::pow(scaled.mean_dn[i] - truth, 2);
      n += 1.0;
    }
  }
  result.plain_square /= n;
  result.scaled_square /= n;
  return result;
}

TEST(DarkScale, BeatsPlainSubtractionWhenTheSensorWarmedBy5K) {
  constexpr int kSeeds = 40;
  const Image radiance = scene();
  const double truth = std::exp2(5.0 / SimulationSettings{}.dark_current_doubling_k);
  double chi_square = 0.0, error = 0.0, plain = 0.0, scaled = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Trial t = trial(5.0, seed, radiance);
    ASSERT_TRUE(t.fitted.needed) << seed;
    chi_square += std::pow((t.fitted.scale - truth) / t.fitted.sigma, 2) / kSeeds;
    error += (t.fitted.scale - truth) / kSeeds;
    plain += t.plain_square / kSeeds;
    scaled += t.scaled_square / kSeeds;
    EXPECT_LT(t.scaled_square, 0.01 * t.plain_square) << seed;  // 10 times less error, in every one
  }
  std::printf("residual on hot pixels, DN rms: plain %.2f, scaled %.2f; scale's mean error %.5f, chi2/n %.3f\n",
              std::sqrt(plain), std::sqrt(scaled), error, chi_square);
  // Chi-square of 40 degrees of freedom over 40: standard deviation 0.22; three of these.
  EXPECT_NEAR(chi_square, 1.0, 0.67);
}

TEST(DarkScale, KeepsOneWhenNothingDrifted) {
  const Image radiance = scene();
  int kept = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) kept += trial(0.0, seed, radiance).fitted.needed ? 0 : 1;
  EXPECT_GE(kept, 47);  // 1 % each err: four or more have a chance of 0.2 %
}

TEST(DarkScale, SaysWhenTheFrameCannotTell) {
  const LinearSensor sensor = linear_sensor(camera(), 0.0);
  const MasterDark master = dark(1);
  const Frame saturated = shot(Image(kWidth, kHeight, 3, 1e6f), kDark_c + 5.0, 1, 7);
  const DarkScale found = fit_dark_scale({{&saturated, &master}}, sensor);
  EXPECT_FALSE(found.determined);
  EXPECT_EQ(found.scale, 1.0);
  EXPECT_THROW(fit_dark_scale({}, sensor), BadInput);
}

TEST(DarkScale, IsAppliedByTheMergeOutsideTheWindowAndOnlyThere) {
  const LinearSensor sensor = linear_sensor(camera(), 0.0);
  DarkLibrary library;
  library.add(dark(3));
  const Image radiance = scene();
  const MosaicRadiance same = merge_bracket({shot(radiance, kDark_c + 1.0, 3, 9)}, library, sensor);
  EXPECT_EQ(same.dark_scale.pixels, 0);
  const MosaicRadiance warm = merge_bracket({shot(radiance, kDark_c + 5.0, 3, 9)}, library, sensor);
  EXPECT_TRUE(warm.dark_scale.needed);
  EXPECT_FALSE(warm.darks_drifted);
  const Frame blind = shot(Image(kWidth, kHeight, 3, 1e6f), kDark_c + 5.0, 3, 9);
  EXPECT_TRUE(merge_bracket({blind}, library, sensor).darks_drifted);
}

}  // namespace
}  // namespace lumitexel
