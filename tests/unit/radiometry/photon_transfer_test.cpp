// The simulated sensor's own numbers found again from frames of a scene with gradients, edges and a highlight that moves.
#include "processing/image/photon_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "drivers/error.h"
#include "sim/sensor.h"

namespace lumitexel {
namespace {

constexpr int kWidth = 256, kHeight = 192;
const std::vector<double> kExposures_s{0.002, 0.016, 0.128};

CameraDescription camera(double full_well_e = 18000.0) {
  CameraDescription camera;
  camera.limits = {.width_px = kWidth, .height_px = kHeight, .bits = 14, .mosaic = Mosaic::Rggb};
  camera.sensor = {.electrons_per_dn = 1.2, .full_well_e = full_well_e, .read_noise_e = 4.0, .black_level_dn = 256.0};
  return camera;
}

// What a careless rig file says: everything is off.
LinearSensor described() {
  LinearSensor sensor = linear_sensor(camera(), 0.0);
  sensor.electrons_per_dn *= 1.2;
  sensor.read_noise_dn *= 0.8;
  sensor.black_level_dn += 3.0;
  sensor.clip_dn *= 1.05;
  return sensor;
}

Image scene(double brightness, int highlight_at) {
  Image radiance(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool white = ((x / 17 + y / 23) & 1) != 0;
      const bool highlight = std::hypot(x - highlight_at, y - 90) < 6.0;
      const double value = brightness * std::exp(0.03 * (y - 96)) * (white ? 1.0 : 0.2) + (highlight ? 2.0 : 0.0);
      for (int c = 0; c < 3; ++c) radiance.at(x, y, c) = static_cast<float>(value);
    }
  }
  return radiance;
}

class Session {
 public:
  Session(std::uint64_t seed, const CameraDescription& which, int darks, double brightness, int moves_px)
      : seed_(seed), camera_(which) {
    settings_.seed = seed;
    for (const double exposure_s : kExposures_s) {
      std::vector<Frame> repetitions;
      for (int i = 0; i < darks; ++i) repetitions.push_back(expose(Image(kWidth, kHeight, 3), exposure_s));
      library.add(make_master_dark(repetitions, linear_sensor(camera_, 0.0)));
    }
    brackets.emplace_back();
    int at = 60;
    for (const double exposure_s : kExposures_s) {
      brackets[0].push_back(expose(scene(brightness, at), exposure_s));
      at += moves_px;
    }
  }
  DarkLibrary library;
  std::vector<std::vector<Frame>> brackets;

 private:
  Frame expose(const Image& radiance, double exposure_s) {
    Frame frame;
    frame.width_px = kWidth;
    frame.height_px = kHeight;
    frame.bits = 14;
    frame.mosaic = Mosaic::Rggb;
    frame.reported.exposure_s = exposure_s;
    frame.samples = SimulatedSensor(camera_, settings_).expose(radiance, frame.reported, 100 * seed_ + count_++);
    return frame;
  }
  std::uint64_t seed_, count_ = 0;
  CameraDescription camera_;
  SimulationSettings settings_;
};

struct Score {
  double mean_error = 0, chi_square = 0, sigma = 0;
  void add(const SensorValue& found, double truth, int seeds) {
    ASSERT_TRUE(found.measured);
    mean_error += (found.value - truth) / truth / seeds;
    chi_square += std::pow((found.value - truth) / found.sigma, 2) / seeds;
    sigma += found.sigma / truth / seeds;
  }
  void expect_honest(const char* name, double chi_tolerance) const {
    std::printf("%-18s relative error %9.6f, sigma %9.6f, chi2/n %.3f\n", name, mean_error, sigma, chi_square);
    EXPECT_NEAR(chi_square, 1.0, chi_tolerance) << name;
  }
};

TEST(PhotonTransfer, FindsTheSensorAndKnowsHowWell) {
  constexpr int kSeeds = 40;
  Score gain, read, black, clip;
  int linear = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Session session(seed, camera(), 4, 0.3, 0);
    const PhotonTransfer found = measure_photon_transfer(session.brackets, session.library, described());
    gain.add(found.electrons_per_dn, 1.2, kSeeds);
    read.add(found.read_noise_dn, 4.0 / 1.2, kSeeds);
    black.add(found.black_level_dn, 256.0, kSeeds);
    clip.add(found.clip_dn, 15256.0, kSeeds);
    linear += found.looks_linear ? 1 : 0;
    EXPECT_NEAR(found.chi_square_per_freedom, 1.0, 0.7) << seed;  // some 50 freedoms: 0.2 one sigma
  }
  // Chi-square of 40 degrees of freedom over 40 scatters by 0.22; three of these.
  gain.expect_honest("electrons per DN", 0.67);
  read.expect_honest("read noise", 0.67);
  black.expect_honest("black level", 0.67);
  clip.expect_honest("saturation", 0.67);
  EXPECT_GE(linear, 0.95 * kSeeds);
}

TEST(PhotonTransfer, IsNotMisledByAHighlightThatMoves) {
  const Session still(3, camera(), 4, 0.3, 0), moving(3, camera(), 4, 0.3, 9);
  const PhotonTransfer a = measure_photon_transfer(still.brackets, still.library, described());
  const PhotonTransfer b = measure_photon_transfer(moving.brackets, moving.library, described());
  EXPECT_GT(b.trimmed_share, a.trimmed_share);
  EXPECT_NEAR(b.electrons_per_dn.value / a.electrons_per_dn.value, 1.0, 3.0 * a.electrons_per_dn.sigma);
  EXPECT_NEAR(b.clip_dn.value, a.clip_dn.value, 0.5);
}

TEST(PhotonTransfer, FallsBackOnTheDescriptionAndSaysSo) {
  const Session black(5, camera(), 4, 0.0, 0);
  std::vector<std::vector<Frame>> nothing;
  const PhotonTransfer dark_only = measure_photon_transfer(nothing, black.library, described());
  EXPECT_FALSE(dark_only.electrons_per_dn.measured);
  EXPECT_EQ(dark_only.sensor.electrons_per_dn, described().electrons_per_dn);
  EXPECT_TRUE(dark_only.read_noise_dn.measured);
  EXPECT_FALSE(dark_only.clip_dn.measured);
  EXPECT_GE(dark_only.notes.size(), 3u);
  const PhotonTransfer blind = measure_photon_transfer({}, {}, described());
  EXPECT_FALSE(blind.read_noise_dn.measured || blind.black_level_dn.measured);
  EXPECT_EQ(blind.sensor.clip_dn, described().clip_dn);
  LinearSensor nonsense = described();
  nonsense.electrons_per_dn = 0.0;
  EXPECT_THROW(measure_photon_transfer({}, {}, nonsense), BadInput);
}

TEST(PhotonTransfer, FindsTheConvertersEndWhereTheWellIsDeeper) {
  const Session session(6, camera(40000.0), 4, 0.3, 0);
  const PhotonTransfer found = measure_photon_transfer(session.brackets, session.library, described());
  EXPECT_NEAR(found.clip_dn.value, 16383.0, 0.01);
  EXPECT_EQ(found.sensor.clip_spread_dn, 0.0);
}

}  // namespace
}  // namespace lumitexel
