#include "processing/image/hdr_merge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drivers/error.h"

namespace lumitexel {
namespace {

LinearSensor test_sensor() {
  LinearSensor sensor;
  sensor.electrons_per_dn = 1.2;
  sensor.read_noise_dn = 3.0;
  sensor.black_level_dn = 256.0;
  sensor.clip_dn = 15000.0;
  return sensor;
}

// Frames of a sensor that does what the noise model says: Poisson electrons, normal read noise, rounding, clipping.
class TestCamera {
 public:
  TestCamera(const LinearSensor& sensor, int width, int height, std::uint64_t seed)
      : sensor_(sensor), width_(width), height_(height), random_(seed) {}

  // rate: DN per second of light, per pixel; dark_dn: dark current's signal, per pixel.
  template <typename Rate, typename Dark>
  Frame expose(double exposure_s, const Rate& rate, const Dark& dark_dn) {
    Frame frame;
    frame.width_px = width_;
    frame.height_px = height_;
    frame.bits = 14;
    frame.reported.exposure_s = exposure_s;
    std::normal_distribution<double> read(0.0, sensor_.read_noise_dn);
    for (int i = 0; i < width_ * height_; ++i) {
      const double electrons = (rate(i) * exposure_s + dark_dn(i)) * sensor_.electrons_per_dn;
      const double shot = electrons > 0.0 ? std::poisson_distribution<long>(electrons)(random_) : 0.0;
      const double dn = sensor_.black_level_dn + shot / sensor_.electrons_per_dn + read(random_);
      frame.samples.push_back(static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, sensor_.clip_dn)));
    }
    return frame;
  }

 private:
  LinearSensor sensor_;
  int width_, height_;
  std::mt19937_64 random_;
};

const auto kNothing = [](int) { return 0.0; };

DarkLibrary darks_for(TestCamera& camera, const std::vector<double>& exposures, int repetitions) {
  DarkLibrary library;
  for (const double exposure : exposures) {
    std::vector<Frame> frames;
    for (int i = 0; i < repetitions; ++i) frames.push_back(camera.expose(exposure, kNothing, kNothing));
    library.add(make_master_dark(frames, test_sensor()));
  }
  return library;
}

TEST(MasterDark, FindsExactlyTheHotPixelsAndTheReadNoise) {
  TestCamera camera(test_sensor(), 100, 100, 1);
  const auto dark = [](int i) { return i % 1000 == 7 ? 200.0 : 0.0; };
  std::vector<Frame> frames;
  for (int i = 0; i < 4; ++i) frames.push_back(camera.expose(0.5, kNothing, dark));
  const MasterDark master = make_master_dark(frames, test_sensor());
  EXPECT_EQ(master.hot_count, 10);
  for (int i = 0; i < 10'000; ++i) EXPECT_EQ(master.hot[static_cast<std::size_t>(i)], i % 1000 == 7 ? 1 : 0);
  // 3e4 degrees of freedom: the pooled variance is known to sqrt(2 / 3e4) = 0.8 %; five of these.
  EXPECT_NEAR(master.pixel_variance_dn2 / test_sensor().variance_dn2(0.0), 1.0, 0.04);
}

TEST(MasterDark, RefusesMixedFramesAndOtherExposures) {
  TestCamera camera(test_sensor(), 8, 8, 1);
  EXPECT_THROW(make_master_dark({}, test_sensor()), BadInput);
  EXPECT_THROW(
      make_master_dark({camera.expose(0.1, kNothing, kNothing), camera.expose(0.2, kNothing, kNothing)}, test_sensor()),
      BadInput);
  const DarkLibrary library = darks_for(camera, {0.1}, 2);
  EXPECT_NO_THROW(library.matching({0.1, 0.0}, 8, 8));
  EXPECT_THROW(library.matching({0.100001, 0.0}, 8, 8), BadInput);
  EXPECT_THROW(library.matching({0.1, 6.0}, 8, 8), BadInput);
  EXPECT_THROW(library.matching({0.1, 0.0}, 8, 9), BadInput);
}

// Each rate is one constant patch of many pixels; the merge must hit it and know by how much it misses.
TEST(HdrMerge, IsUnbiasedAndKnowsItsVariance) {
  constexpr int kWidth = 200, kHeight = 200;
  const std::vector<double> exposures{0.01, 0.08, 0.64};
  for (const double rate : {30.0, 300.0, 5'000.0, 60'000.0, 1'000'000.0}) {
    TestCamera camera(test_sensor(), kWidth, kHeight, 42);
    const DarkLibrary darks = darks_for(camera, exposures, 4);
    std::vector<Frame> bracket;
    for (const double exposure : exposures)
      bracket.push_back(camera.expose(
          exposure, [&](int) { return rate; }, kNothing));
    const MosaicRadiance merged = merge_bracket(bracket, darks, test_sensor());
    double sum = 0.0, chi_square = 0.0, variance = 0.0;
    constexpr double kPixels = kWidth * kHeight;
    for (std::size_t i = 0; i < merged.value.size(); ++i) {
      sum += merged.value[i];
      chi_square += std::pow(merged.value[i] - rate, 2) / merged.variance[i];
      variance += merged.variance[i];
    }
    EXPECT_NEAR(sum / kPixels, rate, 5.0 * std::sqrt(variance / kPixels / kPixels)) << rate;
    // Chi-square of 4e4 degrees of freedom has a relative deviation of sqrt(2 / 4e4) = 0.7 %; five of these.
    EXPECT_NEAR(chi_square / kPixels, 1.0, 0.036) << rate;
  }
}

// A long exposure must weigh in for a faint pixel: merging three must beat the shortest alone by far.
TEST(HdrMerge, UsesTheLongExposureWhereItCan) {
  const std::vector<double> exposures{0.01, 0.64};
  TestCamera camera(test_sensor(), 16, 16, 3);
  const DarkLibrary darks = darks_for(camera, exposures, 4);
  const auto rate = [](int) { return 1000.0; };
  const MosaicRadiance both =
      merge_bracket({camera.expose(0.64, rate, kNothing), camera.expose(0.01, rate, kNothing)}, darks, test_sensor());
  const double ideal =
      (1000.0 * 0.64 / 1.2 + 9.0 * 1.25) / (0.64 * 0.64);  // shot and read noise and a quarter of it again
  EXPECT_LT(both.variance[0], 1.1 * ideal);
}

TEST(HdrMerge, FlagsSaturatedDarkAndDefectivePixels) {
  const std::vector<double> exposures{0.01, 0.1};
  TestCamera camera(test_sensor(), 40, 40, 5);
  const auto hot = [](int i) { return i == 3 ? 3000.0 : 0.0; };
  DarkLibrary darks;
  for (const double exposure : exposures) {
    darks.add(make_master_dark({camera.expose(exposure, kNothing, hot), camera.expose(exposure, kNothing, hot)},
                               test_sensor()));
  }
  const auto rate = [](int i) { return i == 0 ? 1e7 : i == 1 ? 0.0 : i == 2 ? 1e6 : 1e4; };
  const MosaicRadiance merged =
      merge_bracket({camera.expose(0.01, rate, hot), camera.expose(0.1, rate, hot)}, darks, test_sensor());
  EXPECT_EQ(merged.flags[0], kPixelSaturated);
  EXPECT_EQ(merged.flags[1], kPixelDark);
  EXPECT_EQ(merged.flags[2], 0);  // saturated in the long exposure only
  EXPECT_NEAR(merged.value[2], 1e6, 5.0 * std::sqrt(merged.variance[2]));
  EXPECT_EQ(merged.flags[3], kPixelDefective);
  EXPECT_EQ(merged.flags[4], 0);
}

}  // namespace
}  // namespace lumitexel
