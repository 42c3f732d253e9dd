#include "drivers/modbus/modbus_safety.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "drivers/error.h"
#include "modbus_bench.h"

namespace lumitexel {
namespace {

class Safety : public testing::TestWithParam<Transport> {};
INSTANTIATE_TEST_SUITE_P(Over, Safety, testing::Values(Transport::Tcp, Transport::Rtu),
                         [](const auto& it) { return std::string(to_string(it.param)); });

void set_going(const ModbusBench& bench, bool forward = true) {
  for (const BenchLamp lamp : kBenchLamps) bench.bench->switch_lamp(lamp, true);
  bench.bench->start_move(BenchAxis::LightAzimuth, forward ? 110.0 : -110.0);
  bench.bench->start_move(BenchAxis::LightElevation, forward ? 85.0 : -20.0);
  bench.bench->start_move(BenchAxis::Turntable, bench.bench->motion(BenchAxis::Turntable).position + 170.0);
}

bool is_safe(const ModbusBench& bench) {
  return std::none_of(kBenchLamps.begin(), kBenchLamps.end(),
                      [&](BenchLamp lamp) { return bench.bench->is_lit(lamp); }) &&
         std::none_of(kBenchAxes.begin(), kBenchAxes.end(),
                      [&](BenchAxis axis) { return bench.bench->motion(axis).moving; });
}

TEST_P(Safety, MakesEverythingSafeInFewRequests) {
  const ModbusBench bench(quick_settings(GetParam()), 1.0);
  const auto safety = bench.safety();
  set_going(bench);
  ASSERT_FALSE(is_safe(bench));
  ASSERT_TRUE(safety->kick_watchdog());  // so that its connection has been accepted
  const std::uint64_t before = bench.faults->operations("controller");
  EXPECT_TRUE(safety->make_safe());
  EXPECT_TRUE(is_safe(bench));
  // Coils 5 to 9 adjoin, and holding register 10.
  EXPECT_EQ(bench.faults->operations("controller") - before, 2u);
  EXPECT_EQ(bench.server->controller().received_stops().size(), 6u);
}

TEST_P(Safety, GoesOneByOneWithAControllerThatRefusesGroups) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.behaviour.refuses_groups = true;
  const ModbusBench bench(settings, 1.0);
  const auto safety = bench.safety();
  set_going(bench);
  EXPECT_TRUE(safety->make_safe());
  EXPECT_TRUE(is_safe(bench));
}

// From the call to the moment that the controller has carried out the last of it, while the devices' link is in use.
TEST_P(Safety, IsFarBelowASecondBesideABusyLink) {
  const ModbusBench bench(quick_settings(GetParam()), 1.0);
  const auto safety = bench.safety();
  std::jthread busy([&](std::stop_token stop) {
    const auto azimuth = bench.axis(BenchAxis::LightAzimuth);
    while (!stop.stop_requested()) azimuth->position();
  });
  std::vector<double> latencies_ms;
  for (int i = 0; i < 200; ++i) {
    set_going(bench, i % 2 == 0);
    const auto start = std::chrono::steady_clock::now();
    ASSERT_TRUE(safety->make_safe());
    const auto stops = bench.server->controller().received_stops();
    latencies_ms.push_back(std::chrono::duration<double, std::milli>(stops.back().at - start).count());
    ASSERT_TRUE(is_safe(bench));
  }
  std::sort(latencies_ms.begin(), latencies_ms.end());
  std::printf("make_safe over %s, to the controller's last action: median %.2f ms, largest of %zu %.2f ms\n",
              to_string(GetParam()), latencies_ms[latencies_ms.size() / 2], latencies_ms.size(), latencies_ms.back());
  EXPECT_LT(latencies_ms.back(), 250.0);
}

// The devices' request gets no answer for half a second; the safety channel does not wait for it. (On a serial line
// there is no second channel: it waits until that request has timed out.)
TEST_P(Safety, DoesNotWaitForARequestThatHangs) {
  ModbusServerSettings settings = quick_settings(GetParam());
  if (GetParam() == Transport::Tcp) settings.endpoint.response_timeout_s = 0.5;
  const ModbusBench bench(settings, 1.0);
  const auto safety = bench.safety();
  set_going(bench);
  bench.faults->arm_one(Fault::Mute, 0);
  std::jthread stuck([&] { bench.link->read(settings.axes.at(BenchAxis::Turntable).position, "turntable position"); });
  bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.02, {});
  EXPECT_LT(seconds_of([&] { EXPECT_TRUE(safety->make_safe()); }), 0.3);
  EXPECT_TRUE(is_safe(bench));
}

// A serial line that falls back in step after a lost reply does so for seconds with these times; it gives way at once.
TEST_P(Safety, DoesNotWaitForALineThatIsGettingBackInStep) {
  ModbusServerSettings settings = quick_settings(GetParam());
  settings.endpoint.response_timeout_s = 0.6;
  const ModbusBench bench(settings, 1.0);
  const auto safety = bench.safety();
  set_going(bench);
  bench.faults->arm_one(Fault::Mute, 0);
  std::jthread stuck([&] { bench.link->read(settings.axes.at(BenchAxis::Turntable).position, "turntable position"); });
  bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.75, {});  // now it waits for 0.6 s of silence
  EXPECT_LT(seconds_of([&] { EXPECT_TRUE(safety->make_safe()); }), 0.3);
  EXPECT_TRUE(is_safe(bench));
}

TEST_P(Safety, SaysNoInTimeIfNobodyAnswers) {
  ModbusBench bench(GetParam());
  const auto safety = bench.safety();
  set_going(bench);
  bench.faults->arm_all(Fault::Mute);
  EXPECT_LT(seconds_of([&] { EXPECT_FALSE(safety->make_safe()); }), 1.2);
  bench.faults->disarm();
  bench.server.reset();
  EXPECT_LT(seconds_of([&] { EXPECT_FALSE(safety->make_safe()); }), 1.0);
  bench.restart_server();
  EXPECT_TRUE(safety->make_safe());
  EXPECT_TRUE(is_safe(bench));
}

TEST_P(Safety, LeavesOtherControllersAlone) {
  const ModbusBench bench(GetParam());
  ModbusMaps maps = mixed_maps();
  maps.turntable.controller = "another";
  ModbusSafety safety(bench.link, {}, {maps.turntable});
  bench.bench->start_move(BenchAxis::Turntable, 90.0);
  safety.make_safe();
  EXPECT_TRUE(bench.bench->motion(BenchAxis::Turntable).moving);
  EXPECT_EQ(bench.server->controller().received_stops().size(), 0u);
}

ModbusServerSettings with_watchdog(Transport transport) {
  ModbusServerSettings settings = quick_settings(transport);
  settings.endpoint.watchdog = ModbusCommand{{RegisterTable::Holding, 20}, 1.0};
  settings.endpoint.watchdog_period_s = 0.3;
  return settings;
}

TEST_P(Safety, TheWatchdogSwitchesOffWhenNobodyKicksItAndNotBefore) {
  const ModbusBench bench(with_watchdog(GetParam()), 1.0);
  const auto safety = bench.safety();
  set_going(bench);
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(safety->kick_watchdog());
    bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.06, {});
  }
  EXPECT_EQ(bench.server->controller().watchdog_trips(), 0);
  EXPECT_FALSE(is_safe(bench));
  bench.real_clock->sleep_until(bench.real_clock->now_s() + 0.4, {});
  EXPECT_EQ(bench.server->controller().watchdog_trips(), 1);
  EXPECT_TRUE(is_safe(bench));
}

TEST_P(Safety, KickingKeepsTheConnectionWarmWithoutAWatchdog) {
  ModbusBench bench(GetParam());
  const auto safety = bench.safety();
  EXPECT_TRUE(safety->kick_watchdog());
  bench.server.reset();
  EXPECT_FALSE(safety->kick_watchdog());
  bench.restart_server();
  EXPECT_TRUE(safety->kick_watchdog());
}

}  // namespace
}  // namespace lumitexel
