// How fast frames of 4096 x 3072 x 16 bits come through the Aravis driver, against what a client that only counts bytes
// gets from the same sending loop. Both over loopback, in one run. Not a test.
//
//   build/release/tests/bench/gige_throughput [FRAMES] [PACE in MB/s; 0: as fast as it can be sent]
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <thread>

#include "drivers/aravis/aravis_camera.h"
#include "tests/protocol/hastened_clock.h"
#include "sim/protocol/gige/gige_camera_server.h"
#include "sim/protocol/gige/gvsp_stream.h"
#include "sim/protocol/gige/pixel_packing.h"

namespace lumitexel {
namespace {

constexpr int kWidth_px = 4096, kHeight_px = 3072, kPacket_bytes = 9000;
constexpr double kFrame_MB = 2e-6 * kWidth_px * kHeight_px;
constexpr const char* kAddress = "127.83.12.7";

void print_machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string line, model = "unknown";
  while (std::getline(info, line)) {
    if (line.starts_with("model name")) model = line.substr(line.find(':') + 2);
  }
  const std::time_t now = std::time(nullptr);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M", std::gmtime(&now));
  std::printf("%s UTC, %s, %u cores\n", date, model.c_str(), std::thread::hardware_concurrency());
#ifndef NDEBUG
  std::printf("warning: a debug build\n");
#endif
}

// Counts until nothing has come for half a second.
std::size_t count_bytes(const gige::UdpSocket& socket) {
  std::vector<std::uint8_t> buffer(65536);
  std::size_t bytes = 0;
  pollfd ready{socket.descriptor(), POLLIN, 0};
  sockaddr_in from{};
  while (poll(&ready, 1, 500) > 0) bytes += socket.receive(buffer, from).size();
  return bytes;
}

double bare_MB_per_s(int frames, double pace_MB_per_s) {
  GigeCameraOptions options;
  options.address = kAddress;
  options.pace_MB_per_s = pace_MB_per_s;
  gige::GvspStream stream(options);
  gige::UdpSocket client("127.0.0.1", 0, false);
  const int wanted = 64 << 20;
  setsockopt(client.descriptor(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
  socklen_t length = sizeof(sockaddr_in);
  auto frame = std::make_shared<gige::StreamFrame>();
  getsockname(client.descriptor(), reinterpret_cast<sockaddr*>(&frame->to), &length);
  frame->width_px = kWidth_px;
  frame->height_px = kHeight_px;
  frame->packet_size = kPacket_bytes;
  frame->payload.resize(2 * std::size_t{kWidth_px} * kHeight_px);
  std::size_t bytes = 0;
  std::jthread counting([&] { bytes = count_bytes(client); });
  SystemClock clock;
  const double start_s = clock.now_s();
  for (int i = 0; i < frames; ++i) stream.send(frame, {}, {});
  const double took_s = clock.now_s() - start_s;
  counting.join();
  const double sent_MB = kFrame_MB * frames;
  std::printf("bare client: %.1f %% of the bytes arrived\n", 100.0 * static_cast<double>(bytes) / 1e6 / sent_MB);
  return static_cast<double>(bytes) / 1e6 / took_s;
}

// What the simulated camera itself needs for a frame before the first packet: not the driver's doing.
double camera_s_per_frame(SimulatedBench& bench) {
  SystemClock clock;
  const double start_s = clock.now_s();
  constexpr int kTimes = 5;
  for (int i = 0; i < kTimes; ++i) {
    const BenchExposure exposure = bench.expose({1e-4, 0.0}, 1, {});
    const std::vector<std::uint16_t> region(exposure.samples);
    gige::packed(gige::pixel_formats(Mosaic::Mono, 16).front(), region);
  }
  return (clock.now_s() - start_s) / kTimes;
}

double driver_MB_per_s(int frames, double pace_MB_per_s) {
  RigDescription rig;
  rig.camera.limits = {.width_px = kWidth_px, .height_px = kHeight_px, .bits = 16, .exposure_min_s = 1e-5,
                       .exposure_max_s = 1.0, .exposure_step_s = 1e-6};
  const std::vector<std::uint16_t> picture(std::size_t{kWidth_px} * kHeight_px, 1234);
  const auto bench = std::make_shared<SimulatedBench>(
      rig, BenchBehaviour{}, std::make_shared<HastenedClock>(100.0),
      [&picture](const WorldState&, const CameraSettings&, std::uint64_t) { return picture; });
  GigeCameraOptions options;
  options.address = kAddress;
  options.pace_MB_per_s = pace_MB_per_s;
  const GigeCameraServer server(bench, options);
  AravisConnection connection;
  connection.address = kAddress;
  connection.packet_size_bytes = kPacket_bytes;
  AravisCamera camera(connection, rig.camera.limits, std::make_shared<SystemClock>());
  int discarded = 0;
  camera.on_discard([&](const DiscardedFrame& frame) {
    ++discarded;
    std::printf("discarded: %s\n", frame.cause.c_str());
  });
  camera.shoot({1e-4, 0.0}, {}, 0);
  SystemClock clock;
  const double start_s = clock.now_s();
  for (int i = 1; i <= frames; ++i) camera.shoot({1e-4, 0.0}, {}, static_cast<std::uint64_t>(i));
  const double took_s = clock.now_s() - start_s;
  std::printf("driver: %d frames, %d discarded, %lu packets resent\n", frames, discarded,
              static_cast<unsigned long>(server.packets_resent()));
  const double camera_s = camera_s_per_frame(*bench) * frames;
  std::printf("driver: %.0f MB/s all in all, the simulated camera's exposing and packing included\n",
              kFrame_MB * frames / took_s);
  return kFrame_MB * frames / (took_s - camera_s);
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 40;
  const double pace = argc > 2 ? std::max(0.0, std::atof(argv[2])) : 0.0;
  lumitexel::print_machine();
  const double bare = lumitexel::bare_MB_per_s(frames, pace), driver = lumitexel::driver_MB_per_s(frames, pace);
  std::printf("bare client %.0f MB/s, driver %.0f MB/s (checking and decoding included, the camera's own time not), ratio %.2f\n",
              bare, driver, driver / bare);
}
