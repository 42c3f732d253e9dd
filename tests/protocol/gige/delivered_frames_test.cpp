// Frames that a GigE Vision camera delivers to the Aravis driver are the bench's exposures, sample for sample.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "drivers/error.h"
#include "tests/protocol/gige/gige_bench.h"
#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

void expect_exact(const Frame& frame, SimulatedBench& bench, const CameraSettings& asked, std::uint64_t key) {
  EXPECT_EQ(frame.samples, expected_samples(bench, frame));
  EXPECT_TRUE(same_settings(strip_of(frame).settings, asked));
  EXPECT_EQ(strip_of(frame).frame_key, key);
  EXPECT_TRUE(same_settings(frame.reported, asked));
}

TEST(GigeFrame, IsTheBenchsExposureAndSaysWhatItWasTakenWith) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench);
  const auto camera = connect(connection_to(*server), small_limits());
  const CameraSettings asked{0.0125, 6.0};
  const Frame frame = camera->shoot(asked, {}, 41);
  expect_exact(frame, *bench, asked, 41);
  EXPECT_EQ(frame.echoed_key, 41u);
  EXPECT_DOUBLE_EQ(frame.sensor_temperature_c, 31.5);
  const Frame next = camera->shoot(asked, {}, 42);
  EXPECT_GT(next.device_time_s, frame.device_time_s);
  EXPECT_NE(next.device_frame_id, frame.device_frame_id);
  EXPECT_NE(next.samples, frame.samples);
}

struct Format {
  std::string name;
  int bits;
  Mosaic mosaic;
};

class GigePixelFormat : public testing::TestWithParam<Format> {};

TEST_P(GigePixelFormat, DeliversTheSensorsIntegersUnchanged) {
  const CameraLimits limits = small_limits(GetParam().bits, GetParam().mosaic);
  const auto bench = pattern_bench(limits);
  const auto server = serve_camera(bench);
  AravisConnection connection = connection_to(*server);
  connection.pixel_format = GetParam().name;
  const auto camera = connect(connection, limits);
  const Frame frame = camera->shoot({0.01, 0.0}, {}, 7);
  expect_exact(frame, *bench, {0.01, 0.0}, 7);
  EXPECT_EQ(frame.bits, limits.bits);
  EXPECT_EQ(frame.mosaic, limits.mosaic);
}

INSTANTIATE_TEST_SUITE_P(
    EachOne, GigePixelFormat,
    testing::Values(Format{"Mono8", 8, Mosaic::Mono}, Format{"Mono12", 12, Mosaic::Mono},
                    Format{"Mono12Packed", 12, Mosaic::Mono}, Format{"Mono12p", 12, Mosaic::Mono},
                    Format{"Mono16", 16, Mosaic::Mono}, Format{"Mono16", 14, Mosaic::Mono},
                    Format{"BayerRG8", 8, Mosaic::Rggb}, Format{"BayerRG12", 12, Mosaic::Rggb},
                    Format{"BayerGR12Packed", 12, Mosaic::Grbg}, Format{"BayerBG12p", 12, Mosaic::Bggr},
                    Format{"BayerGB16", 16, Mosaic::Gbrg}, Format{"", 8, Mosaic::Bggr}, Format{"", 12, Mosaic::Mono},
                    Format{"", 14, Mosaic::Rggb}),
    [](const auto& param) {
      return (param.param.name.empty() ? std::string("Chosen") : param.param.name) + "_" +
             std::to_string(param.param.bits) + "bits_" + to_string(param.param.mosaic);
    });

TEST(GigeFrame, OfARegionHoldsThatPartOfTheSensor) {
  CameraLimits sensor = small_limits(12, Mosaic::Rggb);
  sensor.width_px = 500;  // so the state strip lies in the first row, outside the region
  const auto bench = pattern_bench(sensor);
  const auto server = serve_camera(bench);
  AravisConnection connection = connection_to(*server);
  connection.region_x_px = 20;
  connection.region_y_px = 10;
  CameraLimits limits = small_limits(12, Mosaic::Rggb);
  limits.height_px = 38;
  const Frame frame = connect(connection, limits)->shoot({0.01, 3.0}, {}, 5);
  const auto whole = bench->expose({0.01, 3.0}, 5, {}).samples;
  ASSERT_EQ(frame.samples.size(), 64u * 38u);
  for (int y = 0; y < 38; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(frame.samples[static_cast<std::size_t>(y * 64 + x)],
                whole[static_cast<std::size_t>((y + 10) * 500 + x + 20)])
          << x << ", " << y;
    }
  }
}

TEST(GigeFrame, WithoutChunksReportsWhatTheRegistersSay) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench, {.chunks = false});
  const auto camera = connect(unnamed_connection_to(*server), small_limits());
  const Frame frame = camera->shoot({0.02, 12.0}, {}, 9);
  EXPECT_TRUE(same_settings(frame.reported, {0.02, 12.0}));
  EXPECT_TRUE(same_settings(strip_of(frame).settings, {0.02, 12.0}));
  EXPECT_FALSE(frame.echoed_key.has_value());
}

class GigeLoss : public testing::TestWithParam<double> {};

TEST_P(GigeLoss, OfPacketsAndReorderingStillDeliverExactFrames) {
  const auto bench = pattern_bench(small_limits(16));
  const auto server = serve_camera(bench, {.loss = GetParam(), .reorder = GetParam(), .seed = 3});
  const auto camera = connect(connection_to(*server), small_limits(16));
  const auto discards = record_discards(*camera);
  for (std::uint64_t key = 1; key <= 40; ++key) {
    expect_exact(camera->shoot({0.002, 0.0}, {}, key), *bench, {0.002, 0.0}, key);
  }
  EXPECT_GT(server->packets_lost(), 0u);
  EXPECT_GT(server->packets_resent(), 0u);
  EXPECT_LE(discards->size(), 2u) << "resending mends nearly every frame";
}

INSTANTIATE_TEST_SUITE_P(Of, GigeLoss, testing::Values(0.01, 0.03, 0.05),
                         [](const auto& param) { return std::to_string(std::lround(100 * param.param)) + "percent"; });

TEST(GigeCameras, OnSeveralAddressesKeepTheirFramesApart) {
  const auto one_bench = pattern_bench(small_limits()), other_bench = pattern_bench(small_limits(16));
  const auto one_server = serve_camera(one_bench), other_server = serve_camera(other_bench);
  const auto one = connect(connection_to(*one_server), small_limits());
  const auto other = connect(connection_to(*other_server), small_limits(16));
  for (std::uint64_t key = 1; key <= 5; ++key) {
    expect_exact(one->shoot({0.01, 0.0}, {}, key), *one_bench, {0.01, 0.0}, key);
    expect_exact(other->shoot({0.03, 6.0}, {}, 100 + key), *other_bench, {0.03, 6.0}, 100 + key);
  }
}

TEST(GigeCamera, ObeysAStopDuringALongExposure) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench);
  const auto camera = connect(connection_to(*server), small_limits());
  std::stop_source stop;
  SystemClock clock;
  const double start_s = clock.now_s();
  std::jthread presser([&] {
    clock.sleep_until(start_s + 0.1, {});
    stop.request_stop();
  });
  EXPECT_THROW(camera->shoot({10.0, 0.0}, stop.get_token(), 1), Cancelled);  // half a second of ours
  EXPECT_LT(clock.now_s() - start_s, 0.4);
}

TEST(GigeCamera, RefusesARigThatPromisesMoreThanTheCameraCan) {
  const auto server = serve_camera(pattern_bench(small_limits()));
  const auto refuse = [&](auto change) {
    CameraLimits limits = small_limits();
    AravisConnection connection = connection_to(*server);
    change(limits, connection);
    connect(connection, limits);
  };
  EXPECT_BAD_INPUT(refuse([](auto& limits, auto&) { limits.width_px = 66; }), "width_px", "64 x 48", server->address());
  EXPECT_BAD_INPUT(refuse([](auto&, auto& c) { c.region_x_px = 2; }), "region_x_px", "64 x 48 at 2, 0");
  EXPECT_BAD_INPUT(refuse([](auto&, auto& c) { c.pixel_format = "Mono8"; }), "pixel_format", "Mono8", "Mono12");
  EXPECT_BAD_INPUT(refuse([](auto& limits, auto&) { limits.mosaic = Mosaic::Rggb; }), "pixel_format", "rggb");
  EXPECT_BAD_INPUT(refuse([](auto&, auto& c) { c.frame_name_feature = "Nonsense"; }), "frame_name_feature");
  EXPECT_BAD_INPUT(refuse([](auto&, auto& c) { c.frame_name_chunk = "ChunkNonsense"; }), "frame_name_chunk");
  EXPECT_THROW(refuse([](auto& limits, auto&) { limits.exposure_max_s = 11.0; }), OutOfRange);
  EXPECT_THROW(refuse([](auto& limits, auto&) { limits.exposure_min_s = 1e-6; }), OutOfRange);
  EXPECT_THROW(refuse([](auto& limits, auto&) { limits.gain_max_db = 30.0; }), OutOfRange);
}

TEST(GigeCamera, RefusesSamplesBeyondTheRigsBits) {
  const auto bench = pattern_bench(small_limits(16));
  const auto server = serve_camera(bench);
  const auto camera = connect(connection_to(*server), small_limits(14));
  EXPECT_THROW(camera->shoot({0.01, 0.0}, {}, 1), Protocol);
}

TEST(GigeCamera, ThatIsNotThereIsReportedSoon) {
  AravisConnection connection;
  connection.address = "127.254.254.254";
  SystemClock clock;
  const double start_s = clock.now_s();
  EXPECT_THROW(connect(connection, small_limits()), Disconnected);
  EXPECT_LT(clock.now_s() - start_s, 2.0);
}

TEST(GigeCamera, UnderAnotherProgramsControlIsNotTaken) {
  const auto server = serve_camera(pattern_bench(small_limits()));
  const auto first = connect(connection_to(*server), small_limits());
  EXPECT_THROW(connect(connection_to(*server), small_limits()), Disconnected);
  EXPECT_EQ(first->shoot({0.01, 0.0}, {}, 1).frame_key, 1u);
}

}  // namespace
}  // namespace lumitexel
