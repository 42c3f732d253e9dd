#include "drivers/gphoto/gphoto_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "drivers/error.h"
#include "drivers/gphoto/camera_raw.h"
#include "tests/protocol/ptp/still_bench.h"

namespace lumitexel {
namespace {

const std::shared_ptr<Clock> kClock = std::make_shared<SystemClock>();

std::unique_ptr<GphotoCamera> connected(const PtpCameraServer& server, double answer_timeout_s = 5.0) {
  return std::make_unique<GphotoCamera>(connection_to(server, answer_timeout_s), still_rig().camera.limits, kClock,
                                        LUMITEXEL_GPHOTO_WORKER);
}

double gain_db(double iso) { return 20.0 * std::log10(iso / 100.0); }

TEST(GphotoCamera, DeliversWhatTheBenchSaw) {
  const auto bench = still_bench();
  const auto server = serve(bench, std::make_shared<NoFaults>());
  const auto camera = connected(*server);
  bench->switch_lamp(BenchLamp::Point, true);
  double last_time_s = 0.0;
  std::uint64_t key = 100;
  for (const CameraSettings settings : {CameraSettings{0.004, 0.0}, {0.0333, gain_db(400)}, {0.001, gain_db(800)}}) {
    const Frame frame = camera->shoot(settings, {}, ++key);
    EXPECT_EQ(objection_to(frame, settings, key), "");
    // The same state, settings and key once more, in process: the pixels must be the same but for the count in the
    // strip.
    const BenchExposure again = bench->expose(camera->quantised(settings), key, {});
    EXPECT_TRUE(std::equal(frame.samples.begin() + 408, frame.samples.end(), again.samples.begin() + 408));
    EXPECT_EQ(frame.echoed_key, key);
    EXPECT_EQ(frame.camera_file_extension, "dng");
    EXPECT_EQ(frame.sensor_temperature_c, 25.0);
    EXPECT_GT(frame.device_time_s, last_time_s);
    last_time_s = frame.device_time_s;
    const CameraRawExif exif = decode_camera_raw(frame.camera_file, "file").exif;
    EXPECT_NEAR(*exif.exposure_s, settings.exposure_s, 1e-12);
    EXPECT_NEAR(gain_db(*exif.iso), settings.gain_db, 1e-9);
  }
}

TEST(GphotoCamera, RefusesWhatTheDialHasNot) {
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  CameraLimits limits = still_rig().camera.limits;
  limits.exposure_choices_s.clear();  // a rig that does not say what the dial has
  GphotoCamera camera(connection_to(*server), limits, kClock, LUMITEXEL_GPHOTO_WORKER);
  try {
    camera.shoot({0.5, 0.0}, {});
    FAIL() << "took 0.5 s";
  } catch (const OutOfRange& error) {
    EXPECT_NE(std::string(error.what()).find("0.0333s"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(server->gphoto_port()), std::string::npos) << error.what();
  }
  EXPECT_EQ(objection_to(camera.shoot({0.004, 0.0}, {}, 5), {0.004, 0.0}, 5), "");
}

TEST(GphotoCamera, ARigThatPromisesWhatTheDialHasNotIsRefusedOnConnecting) {
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  CameraLimits limits = still_rig().camera.limits;
  limits.exposure_choices_s.push_back(0.5);
  try {
    GphotoCamera camera(connection_to(*server), limits, kClock, LUMITEXEL_GPHOTO_WORKER);
    FAIL() << "connected";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("camera.exposure_choices_s: 0.5 s"), std::string::npos) << error.what();
  }
}

TEST(GphotoCamera, MakesFixedSettingsAndSaysWhichItCannot) {
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  GphotoConnection connection = connection_to(*server);
  connection.fixed_settings = {{"f-number", "f/11"}};
  EXPECT_NO_THROW(GphotoCamera(connection, still_rig().camera.limits, kClock, LUMITEXEL_GPHOTO_WORKER));
  connection.fixed_settings = {{"f-number", "f/9"}};  // not on its dial
  connection.reconnect_timeout_s = 1.0;
  try {
    GphotoCamera(connection, still_rig().camera.limits, kClock, LUMITEXEL_GPHOTO_WORKER);
    FAIL() << "took f/9";
  } catch (const Disconnected& error) {
    EXPECT_NE(std::string(error.what()).find("f-number"), std::string::npos) << error.what();
  }
  connection.model = "Box Brownie";
  EXPECT_THROW(GphotoCamera(connection, still_rig().camera.limits, kClock, LUMITEXEL_GPHOTO_WORKER), OutOfRange);
}

// As large as a camera's of 24 megapixels; prints how long it takes.
TEST(GphotoCamera, ALargeFileArrivesWhole) {
  RigDescription rig = still_rig();
  rig.camera.limits.width_px = 6000;
  rig.camera.limits.height_px = 4000;
  const auto server = serve(still_bench(rig), std::make_shared<NoFaults>());
  GphotoCamera camera(connection_to(*server), rig.camera.limits, kClock, LUMITEXEL_GPHOTO_WORKER);
  camera.shoot({0.004, 0.0}, {}, 1);
  const double start_s = kClock->now_s();
  const Frame frame = camera.shoot({0.004, 0.0}, {}, 2);
  const double shot_s = kClock->now_s() - start_s;
  EXPECT_EQ(objection_to(frame, {0.004, 0.0}, 2, rig), "");
  const double megabytes = static_cast<double>(frame.camera_file.size()) / 1e6;
  std::printf("a shot of %.0f MB in %.2f s, with rendering, transfer and decoding: %.0f MB/s\n", megabytes, shot_s,
              megabytes / shot_s);
}

TEST(PtpCameraServer, RefusesExposuresThatPtpCannotSay) {
  RigDescription rig = still_rig();
  for (const double exposure_s : {0.00005, 0.00125, 0.0}) {
    rig.camera.limits.exposure_choices_s = {exposure_s, 0.1};
    EXPECT_THROW(serve(still_bench(rig), std::make_shared<NoFaults>()), BadInput) << exposure_s;
  }
  rig.camera.limits.exposure_choices_s = {};
  rig.camera.limits.exposure_max_s = 0.0009;
  rig.camera.limits.exposure_min_s = 0.0001;
  EXPECT_THROW(serve(still_bench(rig), std::make_shared<NoFaults>()), BadInput);
}

}  // namespace
}  // namespace lumitexel
