#include "sim/simulated_bench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/error.h"
#include "sim/fault_source.h"
#include "sim/state_strip.h"
#include "simulated_bench.h"

namespace lumitexel {
namespace {

class SimulatedBenchTest : public testing::Test {
 protected:
  SimulatedBench bench(BenchBehaviour behaviour = {}) {
    return SimulatedBench(small_bench(), behaviour, clock_,
                          [](const WorldState&, const CameraSettings&, std::uint64_t key) {
                            return std::vector<std::uint16_t>(512, static_cast<std::uint16_t>(key & 0xff));
                          });
  }
  void wait(double time_s) { clock_->sleep_until(clock_->now_s() + time_s, {}); }
  std::shared_ptr<VirtualClock> clock_ = std::make_shared<VirtualClock>();
};

TEST_F(SimulatedBenchTest, AxesTakeTheShortWayAtTheirSpeed) {
  SimulatedBench bench = this->bench();
  bench.start_move(BenchAxis::Turntable, 300.0);  // 60 degrees back, at 20 degrees a second
  wait(1.0);
  EXPECT_NEAR(bench.motion(BenchAxis::Turntable).position, 340.0, 1e-9);
  EXPECT_TRUE(bench.motion(BenchAxis::Turntable).moving);
  wait(2.0);
  EXPECT_EQ(bench.motion(BenchAxis::Turntable).position, 300.0);
  EXPECT_FALSE(bench.motion(BenchAxis::Turntable).moving);
}

TEST_F(SimulatedBenchTest, AHaltedAxisStaysWhereItIs) {
  SimulatedBench bench = this->bench();
  bench.start_move(BenchAxis::LightElevation, 60.0);
  wait(1.0);
  bench.halt(BenchAxis::LightElevation);
  wait(10.0);
  EXPECT_NEAR(bench.motion(BenchAxis::LightElevation).position, 15.0, 1e-9);
}

TEST_F(SimulatedBenchTest, AJammedAxisStandsAndAFreedOneMovesAgain) {
  SimulatedBench bench = this->bench();
  bench.start_move(BenchAxis::LightAzimuth, 90.0);
  wait(1.0);
  bench.jam(BenchAxis::LightAzimuth, true);
  wait(5.0);
  EXPECT_NEAR(bench.motion(BenchAxis::LightAzimuth).position, 15.0, 1e-9);
  bench.jam(BenchAxis::LightAzimuth, false);
  bench.start_move(BenchAxis::LightAzimuth, 30.0);
  wait(1.0);
  EXPECT_EQ(bench.motion(BenchAxis::LightAzimuth).position, 30.0);
}

TEST_F(SimulatedBenchTest, ABrokenLampIsSwitchedOnAndDark) {
  SimulatedBench bench = this->bench();
  bench.break_lamp(BenchLamp::Ring, true);
  bench.switch_lamp(BenchLamp::Ring, true);
  EXPECT_FALSE(bench.is_lit(BenchLamp::Ring));
  EXPECT_FALSE(bench.state().ring_flash);
  bench.break_lamp(BenchLamp::Ring, false);
  EXPECT_TRUE(bench.state().ring_flash);
}

TEST_F(SimulatedBenchTest, SlackAndSwingAreTheTablesNotTheEncoders) {
  BenchBehaviour behaviour;
  behaviour.turntable_backlash_deg = 0.2;
  behaviour.turntable_swing_deg = 0.5;
  SimulatedBench bench = this->bench(behaviour);
  bench.start_move(BenchAxis::Turntable, 20.0);
  wait(1.0 + 1e-6);
  EXPECT_EQ(bench.motion(BenchAxis::Turntable).position, 20.0);
  EXPECT_NEAR(bench.state().turntable_deg, 20.0 - 0.1 + 0.5, 1e-3);
  wait(5.0);
  EXPECT_NEAR(bench.state().turntable_deg, 19.9, 1e-9);
  bench.start_move(BenchAxis::Turntable, 0.0);
  wait(5.0);
  bench.start_move(BenchAxis::Turntable, 40.0);
  wait(5.0);
  bench.start_move(BenchAxis::Turntable, 20.0);
  wait(6.0);
  EXPECT_NEAR(bench.state().turntable_deg, 20.1, 1e-9);
}

TEST_F(SimulatedBenchTest, AnExposureSeesItsMiddleAndNamesTheTruth) {
  BenchBehaviour behaviour;
  behaviour.state_strip = true;
  SimulatedBench bench = this->bench(behaviour);
  bench.switch_lamp(BenchLamp::Point, true);
  bench.start_move(BenchAxis::Turntable, 90.0);
  const BenchExposure exposure = bench.expose({0.5, 3.0}, 77, {});
  EXPECT_NEAR(exposure.state.turntable_deg, 5.0, 1e-9);
  EXPECT_NEAR(clock_->now_s(), 0.5, 1e-12);
  const auto strip = read_state_strip(exposure.samples, 14);
  ASSERT_TRUE(strip.has_value());
  EXPECT_EQ(strip->settings, (CameraSettings{0.5, 3.0}));
  EXPECT_EQ(strip->frame_key, 77u);
  EXPECT_EQ(strip->exposure_count, 1u);
  EXPECT_TRUE(strip->state.point_light);
  EXPECT_FALSE(strip->state.backlight);
}

TEST(StateStrip, AnyFlippedPixelIsNoticed) {
  const StateStrip strip{{1e-5, -2.5}, {359.999, -110.0, 85.0, false, true, true}, ~0ull, 12345};
  std::vector<std::uint16_t> samples(kStateStripPixels, 0);
  write_state_strip(strip, 12, samples);
  const auto read = read_state_strip(samples, 12);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->settings, strip.settings);
  EXPECT_EQ(read->state, strip.state);
  EXPECT_EQ(read->frame_key, strip.frame_key);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<std::uint16_t> flipped = samples;
    flipped[i] = flipped[i] ? 0 : 4095;
    EXPECT_FALSE(read_state_strip(flipped, 12).has_value()) << i;
  }
}

TEST(StateStrip, FramesWithoutOneHaveNone) {
  EXPECT_FALSE(read_state_strip(std::vector<std::uint16_t>(1000, 300), 12).has_value());
  EXPECT_FALSE(read_state_strip(std::vector<std::uint16_t>(10, 300), 12).has_value());
  std::vector<std::uint16_t> few(kStateStripPixels - 1);
  EXPECT_THROW(write_state_strip({}, 12, few), OutOfRange);
}

TEST(FaultSource, OneFaultHappensOnceWhereItIsPossible) {
  OneFault faults("camera", Fault::Mute, 3);
  EXPECT_EQ(faults.next("camera", "a", {Fault::Mute}), Fault::None);
  EXPECT_EQ(faults.next("controller", "a", {Fault::Mute}), Fault::None);
  EXPECT_EQ(faults.next("camera", "b", {Fault::Mute}), Fault::None);
  EXPECT_EQ(faults.next("camera", "c", {Fault::Garbage}), Fault::None);  // the third, where it is not possible
  EXPECT_EQ(faults.next("camera", "d", {Fault::Garbage, Fault::Mute}), Fault::Mute);
  EXPECT_EQ(faults.next("camera", "e", {Fault::Mute}), Fault::None);
  ASSERT_EQ(faults.injected().size(), 1u);
  EXPECT_EQ(faults.injected()[0].operation, "d");
  EXPECT_EQ(faults.injected()[0].count, 4u);
}

TEST(FaultSource, RandomFaultsComeAtTheirRatesAndAgainWithTheirSeed) {
  const std::map<Fault, double> rates{{Fault::Mute, 0.02}, {Fault::Garbage, 0.05}};
  RandomFaults first(rates, 7), second(rates, 7);
  std::map<Fault, int> counts;
  for (int i = 0; i < 20000; ++i) {
    const Fault fault = first.next("camera", "x", {Fault::Garbage, Fault::Mute, Fault::Wedge});
    EXPECT_EQ(second.next("camera", "x", {Fault::Garbage, Fault::Mute, Fault::Wedge}), fault);
    ++counts[fault];
  }
  // Five standard deviations of a binomial count.
  EXPECT_NEAR(counts[Fault::Mute], 400, 5 * 20);
  EXPECT_NEAR(counts[Fault::Garbage], 1000, 5 * 32);
  EXPECT_EQ(counts[Fault::Wedge], 0);
}

TEST(FaultSource, NamesGoBothWays) {
  for (const Fault fault : {Fault::Mute, Fault::LosePackets, Fault::StuckAxis, Fault::CardFull}) {
    EXPECT_EQ(fault_from_string(to_string(fault)), fault);
  }
  EXPECT_THROW(fault_from_string("gremlins"), BadInput);
}

}  // namespace
}  // namespace lumitexel
