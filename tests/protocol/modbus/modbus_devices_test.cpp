// Axes and lamps as the rest of the program sees them, over both transports, without faults.
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <thread>

#include "drivers/error.h"
#include "modbus_bench.h"

namespace lumitexel {
namespace {

class ModbusDevices : public testing::TestWithParam<Transport> {};
INSTANTIATE_TEST_SUITE_P(Over, ModbusDevices, testing::Values(Transport::Tcp, Transport::Rtu),
                         [](const auto& it) { return std::string(to_string(it.param)); });

TEST_P(ModbusDevices, AxesArriveExactlyWhereTheyWereSent) {
  for (const WordOrder order : {WordOrder::HighFirst, WordOrder::LowFirst}) {
    ModbusServerSettings settings = quick_settings(GetParam());
    settings.endpoint.word_order = order;
    const ModbusBench bench(settings);
    const auto table = bench.axis(BenchAxis::Turntable);
    table->move_to(53.3, {});
    EXPECT_EQ(bench.bench->motion(BenchAxis::Turntable).position, 53.3);
    EXPECT_EQ(table->position(), 53.3);
    table->move_to(350.001, {});
    EXPECT_EQ(table->position(), 350.001);
    const auto azimuth = bench.axis(BenchAxis::LightAzimuth);
    azimuth->move_to(-33.5, {});
    EXPECT_EQ(azimuth->position(), -33.5);
    EXPECT_EQ(bench.bench->motion(BenchAxis::LightAzimuth).position, -33.5);
    const auto elevation = bench.axis(BenchAxis::LightElevation);
    elevation->move_to(-19.99, {});
    EXPECT_EQ(bench.bench->motion(BenchAxis::LightElevation).position, -19.99);
  }
}

TEST_P(ModbusDevices, SoftLimitsHoldBeforeAnythingIsSent) {
  const ModbusBench bench(GetParam());
  const auto azimuth = bench.axis(BenchAxis::LightAzimuth);
  const std::uint64_t before = bench.faults->operations("controller");
  EXPECT_THROW(azimuth->move_to(110.5, {}), OutOfRange);
  EXPECT_THROW(azimuth->move_to(std::nan(""), {}), OutOfRange);
  EXPECT_THROW(bench.link->write(bench.settings.axes.at(BenchAxis::LightElevation).target, 400.0, "x"), OutOfRange);
  EXPECT_THROW(bench.link->write(bench.settings.axes.at(BenchAxis::Turntable).position, 1.0, "x"), OutOfRange);
  EXPECT_EQ(bench.faults->operations("controller"), before);
}

TEST_P(ModbusDevices, HomingFindsTheReferenceAndNoAxisMovesWithoutOne) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.behaviour.homed = false;
  const ModbusBench bench(settings);
  bench.bench->start_move(BenchAxis::LightElevation, 40.0);
  for (const BenchAxis which : {BenchAxis::Turntable, BenchAxis::LightElevation}) {
    const auto axis = bench.axis(which);
    EXPECT_THROW(axis->move_to(25.0, {}), Protocol);
    axis->home({});
    EXPECT_EQ(axis->position(), 0.0);
    axis->move_to(25.0, {});
    EXPECT_EQ(axis->position(), 25.0);
    axis->home({});  // it has its reference already
    EXPECT_EQ(axis->position(), 25.0);
  }
}

TEST_P(ModbusDevices, AnAxisThatDoesNotFindItsReferenceIsATimeoutThatNamesIt) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.behaviour.homed = false;
  for (auto& [which, map] : settings.axes) map.home_timeout_s = 0.2 * kBenchHaste;
  const ModbusBench bench(settings);
  const auto axis = bench.axis(BenchAxis::LightElevation);
  // It has to be jammed away from 0, where its reference is.
  bench.bench->start_move(BenchAxis::LightElevation, 40.0);
  bench.bench_clock->sleep_until(bench.bench_clock->now_s() + 1.0, {});
  bench.bench->jam(BenchAxis::LightElevation, true);
  EXPECT_THROW(axis->home({}), Timeout);
  EXPECT_NE(message_of([&] { axis->home({}); }).find("light elevation: told to home"), std::string::npos);
}

TEST_P(ModbusDevices, HaltStopsAMovingAxisWithAndWithoutAStopCommand) {
  for (const bool with_stop : {true, false}) {
    ModbusServerSettings settings = quick_settings(GetParam());
    if (!with_stop) settings.axes.at(BenchAxis::LightAzimuth).stop.reset();
    const ModbusBench bench(settings, 1.0);
    const auto azimuth = bench.axis(BenchAxis::LightAzimuth);
    bench.bench->start_move(BenchAxis::LightAzimuth, 100.0);
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.05, {});
    azimuth->halt();
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.1, {});  // for what it overshot by
    const BenchMotion after = bench.bench->motion(BenchAxis::LightAzimuth);
    EXPECT_FALSE(after.moving);
    EXPECT_GT(after.position, 0.0);
    EXPECT_LT(after.position, 20.0);
  }
}

TEST_P(ModbusDevices, AStopTokenEndsAMotionAndTheAxisStands) {
  const ModbusBench bench(quick_settings(GetParam()), 1.0);
  const auto table = bench.axis(BenchAxis::Turntable);
  std::stop_source stop;
  std::jthread later([&] {
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.1, {});
    stop.request_stop();
  });
  EXPECT_LT(seconds_of([&] { EXPECT_THROW(table->move_to(170.0, stop.get_token()), Cancelled); }), 1.0);
  EXPECT_FALSE(bench.bench->motion(BenchAxis::Turntable).moving);
}

TEST_P(ModbusDevices, LampsFollowAndSayWhatTheyDo) {
  const ModbusBench bench(GetParam());
  for (const BenchLamp which : kBenchLamps) {
    const auto lamp = bench.lamp(which);
    EXPECT_FALSE(lamp->is_on());
    lamp->switch_to(true, {});
    EXPECT_TRUE(bench.bench->is_lit(which));
    EXPECT_TRUE(lamp->is_on());
    lamp->force_off();
    EXPECT_FALSE(bench.bench->is_lit(which));
    EXPECT_FALSE(lamp->is_on());
  }
}

TEST_P(ModbusDevices, AStuckAxisEndsInTheErrorThatNamesIt) {
  for (const int number : {0, 42}) {
    ModbusServerSettings settings = quick_settings(GetParam());
    settings.behaviour.stuck_axis_fault = number;
    const ModbusBench bench(settings);
    AxisLimits limits = bench.bench->limits(BenchAxis::Turntable);
    limits.grace_s = 0.2 * kBenchHaste;
    ModbusAxis table("turntable", bench.link, settings.axes.at(BenchAxis::Turntable), limits, bench.bench_clock);
    bench.faults->arm_one(Fault::StuckAxis, 0);
    const auto move = [&] { table.move_to(20.0, {}); };
    const std::string message = message_of(move);
    EXPECT_NE(message.find("turntable"), std::string::npos) << message;
    EXPECT_EQ(message.find("fault 42") != std::string::npos, number == 42) << message;
    if (number == 0) {
      EXPECT_THROW(move(), Timeout);
    }
    bench.bench->jam(BenchAxis::Turntable, false);
    bench.axis(BenchAxis::Turntable)->move_to(20.0, {});  // the stop has acknowledged the fault
    EXPECT_EQ(table.position(), 20.0);
  }
}

TEST_P(ModbusDevices, ALampThatFailsEndsInTheErrorThatNamesIt) {
  for (const int number : {0, 17}) {
    ModbusServerSettings settings = quick_settings(GetParam());
    settings.behaviour.lamp_fault = number;
    const ModbusBench bench(settings);
    const ModbusLampMap& map = settings.lamps.at(BenchLamp::Point);
    const auto lamp = std::make_unique<ModbusLamp>("point light", bench.link, map, bench.bench_clock);
    bench.faults->arm_one(Fault::LampFails, 0);
    std::string message;
    try {
      lamp->switch_to(true, {});
      ADD_FAILURE() << "threw nothing";
    } catch (const Timeout& error) {
      EXPECT_EQ(number, 0);
      message = error.what();
    } catch (const Protocol& error) {
      EXPECT_EQ(number, 17);
      message = error.what();
      EXPECT_NE(message.find("fault 17"), std::string::npos) << message;
    }
    EXPECT_NE(message.find("point light"), std::string::npos) << message;
  }
}

// 10^4 readings of a position whose low word turns over about 300 times a second.
TEST_P(ModbusDevices, NoReadingOfAMovingAxisIsTorn) {
  ModbusServerSettings settings = quick_settings(GetParam());
  ModbusAxisMap& map = settings.axes.at(BenchAxis::Turntable);
  map.position.counts_per_unit = map.target.counts_per_unit = 1e6;
  const ModbusBench bench(settings, 1.0);
  const int readings = GetParam() == Transport::Tcp ? 10'000 : 1'000;
  bench.bench->start_move(BenchAxis::Turntable, 179.0);
  int moved = 0;
  double last = 0.0;
  for (int i = 0; i < readings; ++i) {
    const double before = bench.bench->motion(BenchAxis::Turntable).position;
    const double position = bench.link->read(map.position, "turntable position");
    const double after = bench.bench->motion(BenchAxis::Turntable).position;
    ASSERT_GE(position, before - 1e-6) << "reading " << i;
    ASSERT_LE(position, after + 1e-6) << "reading " << i;
    moved += position > last ? 1 : 0;
    last = position;
  }
  EXPECT_GT(moved, readings / 2);
}

}  // namespace
}  // namespace lumitexel
