// A camera that was away is brought back, and nothing that it forgot goes unnoticed.
#include <gtest/gtest.h>

#include "drivers/error.h"
#include "tests/protocol/gige/gige_bench.h"

namespace lumitexel {
namespace {

const CameraSettings kSettings{0.02, 3.0};

void expect_right(const Frame& frame, SimulatedBench& bench, std::uint64_t key) {
  EXPECT_TRUE(same_settings(strip_of(frame).settings, kSettings));
  EXPECT_EQ(strip_of(frame).frame_key, key);
  EXPECT_EQ(frame.samples, expected_samples(bench, frame));
}

TEST(GigeReconnect, AfterARebootSetsAndVerifiesEverythingAgain) {
  // A reboot resets format (the shortest: Mono12), chunks, trigger, exposure and packet size.
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench, {.silence_s = 0.3});
  AravisConnection connection = connection_to(*server);
  connection.pixel_format = "Mono12Packed";
  const auto camera = connect(connection, small_limits());
  const auto discards = record_discards(*camera);
  expect_right(camera->shoot(kSettings, {}, 1), *bench, 1);
  server->reboot();
  expect_right(camera->shoot(kSettings, {}, 2), *bench, 2);
  EXPECT_FALSE(discards->empty());
}

TEST(GigeReconnect, TakesControlBackWhenItWasWithdrawn) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench);
  const auto camera = connect(connection_to(*server), small_limits());
  expect_right(camera->shoot(kSettings, {}, 1), *bench, 1);
  for (std::uint64_t key = 2; key <= 4; ++key) {
    server->withdraw_control();
    SystemClock clock;
    clock.sleep_until(clock.now_s() + 0.05, {});
    expect_right(camera->shoot(kSettings, {}, key), *bench, key);
  }
}

TEST(GigeReconnect, AfterALongSilenceIsPossibleToo) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench, {.silence_s = 3.0});
  const auto camera = connect(connection_to(*server), small_limits());
  expect_right(camera->shoot(kSettings, {}, 1), *bench, 1);
  server->reboot();
  expect_right(camera->shoot(kSettings, {}, 2), *bench, 2);
}

TEST(GigeReconnect, IsGivenUpInTimeWhenTheCameraStaysAway) {
  const auto bench = pattern_bench(small_limits());
  auto server = serve_camera(bench);
  AravisConnection connection = connection_to(*server);
  connection.reconnect_timeout_s = 0.5;
  const auto camera = connect(connection, small_limits());
  server.reset();
  SystemClock clock;
  const double start_s = clock.now_s();
  try {
    camera->shoot(kSettings, {}, 1, 2);
    ADD_FAILURE() << "a frame came from a camera that is gone";
  } catch (const Disconnected& error) {
    EXPECT_NE(std::string(error.what()).find(camera->name()), std::string::npos) << error.what();
  }
  // The library waits 2.5 s for each command under way, its heartbeat among them.
  EXPECT_LT(clock.now_s() - start_s, 25.0);
  // And not at the price of the same wait again and again.
  EXPECT_THROW(camera->shoot(kSettings, {}, 2, 1), Disconnected);
}

TEST(GigeReconnect, ToACameraThatCannotDoWhatTheRigPromisesBlamesTheDescription) {
  const auto bench = pattern_bench(small_limits());
  auto server = serve_camera(bench);
  const auto camera = connect(connection_to(*server), small_limits());
  GigeCameraOptions other;
  other.address = server->address();
  other.serial = "0002";
  server.reset();
  CameraLimits lesser = small_limits();
  lesser.exposure_max_s = 1.0;
  server = std::make_unique<GigeCameraServer>(pattern_bench(lesser), other);
  EXPECT_THROW(camera->shoot(kSettings, {}, 1), OutOfRange);
}

}  // namespace
}  // namespace lumitexel
