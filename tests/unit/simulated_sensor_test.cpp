#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "sim/seeded_random.h"
#include "sim/sensor.h"
#include "simulated_bench.h"

namespace lumitexel {
namespace {

struct Moments {
  double mean = 0, variance = 0;
};

// Of the difference of two frames for the variance, so that fixed differences between pixels do not count.
Moments moments(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b) {
  const double n = static_cast<double>(a.size());
  double sum = 0.0, difference_sq = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += 0.5 * (a[i] + b[i]);
    difference_sq += std::pow(static_cast<double>(a[i]) - b[i], 2);
  }
  return {sum / n, 0.5 * difference_sq / n};
}

SimulationSettings quiet_settings() {
  SimulationSettings settings = plain_settings();
  settings.hot_pixel_fraction = 0.0;
  settings.dark_current_e_per_s = 0.0;
  return settings;
}

TEST(CounterRandom, PoissonHasEqualMeanAndVariance) {
  for (const double mean : {0.3, 4.0, 49.0, 51.0, 3000.0}) {
    double sum = 0.0, square_sum = 0.0;
    constexpr int kDraws = 40000;
    for (std::uint64_t i = 0; i < kDraws; ++i) {
      const double draw = CounterRandom(11, i).poisson(mean) - mean;
      sum += draw;
      square_sum += draw * draw;
    }
    EXPECT_NEAR(sum / kDraws, 0.0, 4.0 * std::sqrt(mean / kDraws)) << mean;
    // Relative standard error of a variance: sqrt((2 + 1 / mean) / draws); rounding adds 1/12.
    EXPECT_NEAR(square_sum / kDraws / mean, 1.0, 4.0 * std::sqrt((2.0 + 1.0 / mean) / kDraws) + 0.09 / mean * (mean > 50))
        << mean;
  }
  EXPECT_EQ(CounterRandom(1, 2).poisson(0.0), 0.0);
}

TEST(SimulatedSensor, PhotonTransferGivesTheConversionGain) {
  const CameraDescription camera = small_bench().camera;
  const SimulatedSensor sensor(camera, quiet_settings());
  for (const double radiance : {0.05, 0.5}) {
    const Image flat(256, 192, 3, static_cast<float>(radiance));
    const CameraSettings settings{.exposure_s = 0.1};
    const Moments seen = moments(sensor.expose(flat, settings, 1), sensor.expose(flat, settings, 2));
    const double electrons = 2e5 * 0.1 * radiance;
    EXPECT_NEAR(seen.mean - 256.0, electrons / 1.2, 5.0 * std::sqrt(electrons / (2.0 * 256 * 192)));
    const double read_dn2 = std::pow(4.0 / 1.2, 2) + 1.0 / 12.0;
    const double electrons_per_dn = (seen.mean - 256.0) / (seen.variance - read_dn2);
    EXPECT_NEAR(electrons_per_dn, 1.2, 0.03 * 1.2);  // 49152 differences: 0.64 % one sigma
  }
}

TEST(SimulatedSensor, DarkFramesShowReadNoiseAndDarkCurrentAtTheSensorsTemperature) {
  SimulationSettings settings = quiet_settings();
  settings.dark_current_e_per_s = 50.0;
  settings.sensor_temperature_c = 27.0;  // one doubling
  const SimulatedSensor sensor(small_bench().camera, settings);
  const Image black(256, 192, 3);
  const Moments brief = moments(sensor.expose(black, {.exposure_s = 1e-5}, 1), sensor.expose(black, {.exposure_s = 1e-5}, 2));
  EXPECT_NEAR(brief.mean, 256.0, 0.1);
  EXPECT_NEAR(std::sqrt(brief.variance), std::hypot(4.0 / 1.2, std::sqrt(1.0 / 12.0)), 0.07);
  const Moments lasting = moments(sensor.expose(black, {.exposure_s = 6.0}, 1), sensor.expose(black, {.exposure_s = 6.0}, 2));
  EXPECT_NEAR(lasting.mean - 256.0, 2.0 * 50.0 * 6.0 / 1.2, 0.5);
}

TEST(SimulatedSensor, HotPixelsAreTheStatedShareAndStayWhereTheyAre) {
  SimulationSettings settings = plain_settings();
  settings.hot_pixel_fraction = 0.01;
  const SimulatedSensor sensor(small_bench().camera, settings);
  int hot = 0;
  double ordinary_current = 0.0, hot_sum = 0.0;
  for (int y = 0; y < 192; ++y) {
    for (int x = 0; x < 256; ++x) {
      const double current = sensor.dark_current_e_per_s(x, y);
      if (sensor.is_hot(x, y)) {
        ++hot;
        hot_sum += current;
      } else {
        ordinary_current = current;
      }
    }
  }
  EXPECT_NEAR(hot, 0.01 * 256 * 192, 4.0 * std::sqrt(0.01 * 256 * 192));
  EXPECT_NEAR(ordinary_current, 2.0 * std::exp2(5.0 / 7.0), 1e-12);
  const double warmth = std::exp2(5.0 / 7.0);
  EXPECT_NEAR(hot_sum / hot, 2002.0 * warmth, 4.0 * 2000.0 * warmth / std::sqrt(hot));
}

TEST(SimulatedSensor, SaturatesAtTheFullWellAndNeverPassesItsBits) {
  const Image bright(256, 192, 3, 100.0f);
  const CameraDescription camera = small_bench().camera;
  const Moments full = moments(SimulatedSensor(camera, quiet_settings()).expose(bright, {.exposure_s = 1.0}, 1),
                               SimulatedSensor(camera, quiet_settings()).expose(bright, {.exposure_s = 1.0}, 2));
  EXPECT_NEAR(full.mean, 256.0 + 18000.0 / 1.2, 0.2);
  CameraDescription deep = camera;
  deep.sensor.full_well_e = 40000.0;
  for (const std::uint16_t sample : SimulatedSensor(deep, quiet_settings()).expose(bright, {.exposure_s = 1.0}, 1)) {
    ASSERT_EQ(sample, 16383);
  }
}

TEST(SimulatedSensor, GainScalesTheSamplesAndNotTheBlackLevel) {
  const SimulatedSensor sensor(small_bench().camera, quiet_settings());
  const Image flat(256, 192, 3, 0.2f);
  const CameraSettings doubled{.exposure_s = 0.1, .gain_db = 20.0 * std::log10(2.0)};
  const Moments seen = moments(sensor.expose(flat, doubled, 1), sensor.expose(flat, doubled, 2));
  EXPECT_NEAR(seen.mean - 256.0, 2.0 * 4000.0 / 1.2, 2.0);
}

TEST(SimulatedSensor, EveryMosaicPutsItsColoursInPlace) {
  Image colours(256, 192, 3);
  for (int y = 0; y < 192; ++y) {
    for (int x = 0; x < 256; ++x) {
      for (int c = 0; c < 3; ++c) colours.at(x, y, c) = 0.1f * static_cast<float>(c + 1);
    }
  }
  const std::pair<Mosaic, std::array<int, 4>> expected[] = {{Mosaic::Rggb, {1, 2, 2, 3}}, {Mosaic::Bggr, {3, 2, 2, 1}},
                                                            {Mosaic::Grbg, {2, 1, 3, 2}}, {Mosaic::Gbrg, {2, 3, 1, 2}},
                                                            {Mosaic::Mono, {2, 2, 2, 2}}};
  for (const auto& [mosaic, tenths] : expected) {
    CameraDescription camera = small_bench().camera;
    camera.limits.mosaic = mosaic;
    const auto samples = SimulatedSensor(camera, quiet_settings()).expose(colours, {.exposure_s = 0.1}, 1);
    std::array<double, 4> mean{};
    for (std::size_t i = 0; i < samples.size(); ++i) mean[(i / 256 % 2) * 2 + i % 2] += (samples[i] - 256.0) / 12288.0;
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(mean[k], 2000.0 * tenths[k] / 1.2, 5.0) << to_string(mosaic) << k;
  }
}

TEST(SimulatedSensor, PixelsDependOnTheKeyAndNotOnTheNumberOfThreads) {
  const SimulatedSensor sensor(small_bench().camera, plain_settings());
  const Image flat(256, 192, 3, 0.3f);
  std::vector<std::uint16_t> samples[2];
  for (const std::size_t threads : {1u, 2u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    samples[threads - 1] = sensor.expose(flat, {.exposure_s = 0.1}, 5);
  }
  EXPECT_EQ(samples[0], samples[1]);
  EXPECT_NE(samples[0], sensor.expose(flat, {.exposure_s = 0.1}, 6));
}

}  // namespace
}  // namespace lumitexel
