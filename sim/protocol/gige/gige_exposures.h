// Turns triggers into frames: exposes on the bench, writes image and chunks, hands them to the stream. On a thread of its
// own, so that a slow exposure never keeps the control channel waiting.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "sim/fault_source.h"
#include "sim/protocol/gige/gvsp_stream.h"
#include "sim/protocol/gige/pixel_packing.h"
#include "sim/simulated_bench.h"

namespace lumitexel::gige {

// What the registers held when the trigger came.
struct ExposureOrder {
  CameraSettings settings;
  std::uint64_t frame_name = 0;
  PixelFormat format;
  std::uint32_t width_px = 0, height_px = 0, offset_x_px = 0, offset_y_px = 0;
  std::uint32_t packet_size = 1500;
  unsigned chunk_mask = 0;
  sockaddr_in to{};
};

class GigeExposures {
 public:
  // on_disconnect: called for the fault of that name, from the exposing thread.
  GigeExposures(std::shared_ptr<SimulatedBench> bench, const GigeCameraOptions& options,
                std::shared_ptr<FaultSource> faults, std::function<void()> on_disconnect);
  ~GigeExposures();

  // Takes a trigger unless one is exposing or waiting already: then nothing happens, as with real cameras.
  void trigger(const ExposureOrder& order);
  // Throws away what is exposing, waiting or going out; ends a wedge.
  void abort();
  // As after power on: block ids, time and late settings start anew.
  void boot();

  // Ends the exposing thread; what comes after is ignored.
  void finish();

  std::uint64_t now_ns() const;  // the camera's own time
  GvspStream& stream() { return stream_; }
  std::uint64_t frames_sent() const { return frames_sent_; }

 private:
  void work(std::stop_token stop);
  void carry_out(const ExposureOrder& order, std::stop_token stop);
  Fault choose_fault(const ExposureOrder& order);
  CameraSettings landed(const CameraSettings& asked);
  std::shared_ptr<StreamFrame> frame_of(const ExposureOrder& order, const BenchExposure& exposure,
                                        const CameraSettings& claimed, std::uint64_t timestamp_ns);
  void deliver(std::shared_ptr<StreamFrame> frame, Fault fault, std::stop_token stop);

  std::shared_ptr<SimulatedBench> bench_;
  GigeCameraOptions options_;
  std::shared_ptr<FaultSource> faults_;
  std::function<void()> on_disconnect_;
  GvspStream stream_;
  std::atomic<double> boot_s_;
  std::atomic<std::uint64_t> frames_sent_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<ExposureOrder> waiting_;
  bool exposing_ = false, wedged_ = false;
  std::stop_source current_;
  std::deque<CameraSettings> asked_;  // the last triggers' settings, oldest first
  std::optional<CameraSettings> previous_;
  std::shared_ptr<StreamFrame> last_frame_;
  std::uint16_t last_block_ = 0;

  std::jthread worker_;  // the last member: ends before what it uses
};

}  // namespace lumitexel::gige
