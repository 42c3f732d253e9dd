// Frames that a GigE Vision camera delivers to the Aravis driver are the bench's exposures, sample for sample.
#include <gtest/gtest.h>

#include "drivers/error.h"
#include "tests/protocol/gige/gige_bench.h"
#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

TEST(GigeFrame, IsTheBenchsExposureAndSaysWhatItWasTakenWith) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench);
  const auto camera = connect(connection_to(*server), small_limits());
  const CameraSettings asked{0.0125, 6.0};
  const Frame frame = camera->shoot(asked, {}, 41);
  EXPECT_EQ(frame.samples, expected_samples(*bench, frame));
  EXPECT_TRUE(same_settings(strip_of(frame).settings, asked));
  EXPECT_TRUE(same_settings(frame.reported, asked));
  EXPECT_EQ(strip_of(frame).frame_key, 41u);
  EXPECT_EQ(frame.echoed_key, 41u);
  EXPECT_DOUBLE_EQ(frame.sensor_temperature_c, 31.5);
  const Frame next = camera->shoot(asked, {}, 42);
  EXPECT_GT(next.device_time_s, frame.device_time_s);
  EXPECT_NE(next.device_frame_id, frame.device_frame_id);
  EXPECT_NE(next.samples, frame.samples);
}

}  // namespace
}  // namespace lumitexel
