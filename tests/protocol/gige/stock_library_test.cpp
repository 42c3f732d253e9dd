// Our camera with a client that is not ours, and our driver with a camera that is not ours: Aravis's own of both.
#include <arv.h>
#include <gtest/gtest.h>

#include <cstring>

#include "drivers/error.h"
#include "tests/protocol/gige/gige_bench.h"

namespace lumitexel {
namespace {

TEST(StockClient, OpensTheSimulatedCameraByItsAddressAndTakesAPicture) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench, {.serial = "S4711"});
  GError* error = nullptr;
  ArvCamera* camera = arv_camera_new(server->address().c_str(), &error);
  ASSERT_EQ(error, nullptr) << error->message;
  EXPECT_STREQ(arv_camera_get_vendor_name(camera, nullptr), "Lumitexel");
  EXPECT_STREQ(arv_camera_get_device_serial_number(camera, nullptr), "S4711");
  arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  arv_camera_set_exposure_time(camera, 25000.0, nullptr);
  arv_camera_set_trigger(camera, "Software", &error);
  ASSERT_EQ(error, nullptr) << error->message;
  ArvStream* stream = arv_camera_create_stream(camera, nullptr, nullptr, nullptr);
  arv_stream_push_buffer(stream, arv_buffer_new(arv_camera_get_payload(camera, nullptr), nullptr));
  arv_camera_start_acquisition(camera, nullptr);
  arv_camera_software_trigger(camera, &error);
  ASSERT_EQ(error, nullptr) << error->message;
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream, 3'000'000);
  ASSERT_NE(buffer, nullptr);
  EXPECT_EQ(arv_buffer_get_status(buffer), ARV_BUFFER_STATUS_SUCCESS);
  std::size_t size = 0;
  const void* data = arv_buffer_get_image_data(buffer, &size);
  ASSERT_EQ(size, 64u * 48u * 2u);
  Frame frame;
  frame.bits = 12;
  frame.samples.resize(64 * 48);
  std::memcpy(frame.samples.data(), data, size);
  EXPECT_EQ(frame.samples, expected_samples(*bench, frame));
  EXPECT_DOUBLE_EQ(strip_of(frame).settings.exposure_s, 0.025);
  g_object_unref(buffer);
  g_object_unref(stream);
  g_object_unref(camera);
}

constexpr std::size_t kStockPixels = 256 * 128;

// Each sample names its place, so that a shifted or shuffled picture shows.
void fill_with_places(ArvBuffer* buffer, void*, guint32, guint32, ArvPixelFormat) {
  // The buffer's own size is that of what it has received: of nothing yet.
  std::size_t received = 0;
  auto* bytes = static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, &received)));
  for (std::size_t i = 0; i < kStockPixels; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
}

TEST(StockCamera, DeliversItsPicturesToOurDriver) {
  ArvGvFakeCamera* stock = nullptr;
  std::string address;
  for (int i = 1; i < 20 && stock == nullptr; ++i) {
    address = "127.0.0.1";  // the library binds it to an interface's own address only
    stock = arv_gv_fake_camera_new_full(address.c_str(), "GV77", nullptr);
    if (stock != nullptr && !arv_gv_fake_camera_is_running(stock)) g_clear_object(&stock);
    if (stock == nullptr) {
      SystemClock clock;
      clock.sleep_until(clock.now_s() + 0.5, {});  // another test process may be using it
    }
  }
  if (stock == nullptr) GTEST_SKIP() << "127.0.0.1:3956 is taken: the stock camera cannot be served";
  ArvFakeCamera* fake = arv_gv_fake_camera_get_fake_camera(stock);
  arv_fake_camera_set_fill_pattern(fake, fill_with_places, nullptr);
  arv_fake_camera_set_trigger_frequency(fake, 1000.0);
  {
    AravisConnection connection;
    connection.address = address;
    connection.pixel_format = "Mono8";
    connection.packet_size_bytes = 1500;
    connection.answer_timeout_s = 1.0;
    const CameraLimits limits{.width_px = 256, .height_px = 128, .bits = 8, .exposure_min_s = 1e-3,
                              .exposure_max_s = 0.1, .exposure_step_s = 1e-6, .gain_min_db = 0, .gain_max_db = 10};
    const auto camera = connect(connection, limits);
    const Frame frame = camera->shoot({0.005, 2.0}, {}, 1);
    ASSERT_EQ(frame.samples.size(), kStockPixels);
    for (std::size_t i = 0; i < frame.samples.size(); ++i) {
      ASSERT_EQ(frame.samples[i], static_cast<std::uint8_t>(i * 7 + i / 256)) << "sample " << i;
    }
    EXPECT_TRUE(same_settings(frame.reported, {0.005, 2.0}));
  }
  g_object_unref(stock);
}

}  // namespace
}  // namespace lumitexel
