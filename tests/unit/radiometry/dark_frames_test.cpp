#include "processing/image/dark_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/error.h"
#include "test_camera.h"

namespace lumitexel {
namespace {

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
}

Frame asked(double exposure_s, double gain_db, int width, int height) {
  Frame frame;
  frame.reported = {exposure_s, gain_db};
  frame.width_px = width;
  frame.height_px = height;
  frame.bits = 14;
  return frame;
}

TEST(DarkLibrary, MatchesExactlyAndNeverTheNearest) {
  TestCamera camera(test_sensor(), 8, 8, 1);
  const DarkLibrary library = darks_for(camera, {0.1}, 2);
  EXPECT_NO_THROW(library.matching(asked(0.1, 0.0, 8, 8)));
  EXPECT_THROW(library.matching(asked(0.100001, 0.0, 8, 8)), BadInput);
  EXPECT_THROW(library.matching(asked(0.1, 6.0, 8, 8)), BadInput);
  EXPECT_THROW(library.matching(asked(0.1, 0.0, 8, 9)), BadInput);
  Frame other = asked(0.1, 0.0, 8, 8);
  other.bits = 12;
  EXPECT_THROW(library.matching(other), BadInput);
  other.bits = 14;
  other.mosaic = Mosaic::Rggb;
  EXPECT_THROW(library.matching(other), BadInput);
}

MasterDark dark_at(TestCamera& camera, double temperature_c) {
  std::vector<Frame> frames(2, camera.expose(0.1, kNothing, kNothing));
  for (Frame& frame : frames) frame.sensor_temperature_c = temperature_c;
  return make_master_dark(frames, test_sensor());
}

TEST(DarkLibrary, TakesTheNearestTemperatureAndSaysWhetherItIsNearEnough) {
  using Temperature = DarkMatch::Temperature;
  TestCamera camera(test_sensor(), 8, 8, 1);
  DarkLibrary library;
  for (const double temperature_c : {0.0, 20.0, 25.0}) library.add(dark_at(camera, temperature_c));
  const auto match = [&](double temperature_c) {
    Frame frame = asked(0.1, 0.0, 8, 8);
    frame.sensor_temperature_c = temperature_c;
    const DarkMatch found = library.matching(frame);
    return std::pair(found.dark->temperature_c.value_or(-1.0), found.temperature);
  };
  EXPECT_EQ(match(24.0), std::pair(25.0, Temperature::Same));
  EXPECT_EQ(match(20.0 + kDarkTemperatureWindow_k), std::pair(20.0, Temperature::Same));
  EXPECT_EQ(match(30.0), std::pair(25.0, Temperature::Drifted));
  EXPECT_EQ(match(0.0).second, Temperature::Unknown);  // exactly 0: the camera did not say
}

TEST(MasterDark, RefusesRepetitionsAtDifferentTemperatures) {
  TestCamera camera(test_sensor(), 8, 8, 1);
  std::vector<Frame> frames(2, camera.expose(0.1, kNothing, kNothing));
  frames[0].sensor_temperature_c = 20.0;
  frames[1].sensor_temperature_c = 24.0;
  EXPECT_THROW(make_master_dark(frames, test_sensor()), BadInput);
  frames[1].sensor_temperature_c = 0.0;  // unknown: nothing to object to, and nothing known of the mean
  EXPECT_FALSE(make_master_dark(frames, test_sensor()).temperature_c.has_value());
  frames.push_back(frames[0]);
  frames[2].sensor_temperature_c = 21.0;
  const auto groups = grouped_by_temperature(frames);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].size(), 1u);
  EXPECT_EQ(make_master_dark(groups[1], test_sensor()).temperature_c, 20.5);
}

}  // namespace
}  // namespace lumitexel
