#include "sim/protocol/gige/gige_exposures.h"

#include <array>
#include <bit>
#include <cmath>

#include "drivers/error.h"
#include "sim/protocol/gige/gige_registers.h"
#include "sim/protocol/gige/register_block.h"

namespace lumitexel::gige {
namespace {

constexpr double kLostByFault = 0.3, kReorderedByFault = 0.5;
constexpr double kFalseExposureFactor = 1.5;

std::vector<std::uint16_t> region_of(const ExposureOrder& order, const std::vector<std::uint16_t>& samples,
                                     int sensor_width_px) {
  std::vector<std::uint16_t> region;
  region.reserve(std::size_t{order.width_px} * order.height_px);
  for (std::uint32_t y = 0; y < order.height_px; ++y) {
    const auto row = samples.begin() + static_cast<std::ptrdiff_t>(order.offset_y_px + y) * sensor_width_px;
    region.insert(region.end(), row + order.offset_x_px, row + order.offset_x_px + order.width_px);
  }
  return region;
}

void append_chunk(std::vector<std::uint8_t>& payload, std::uint32_t id, std::uint64_t bits) {
  append_be64(payload, bits);
  append_be32(payload, id);
  append_be32(payload, 8);
}

}  // namespace

GigeExposures::GigeExposures(std::shared_ptr<SimulatedBench> bench, const GigeCameraOptions& options,
                             std::shared_ptr<FaultSource> faults, std::function<void()> on_disconnect)
    : bench_(std::move(bench)),
      options_(options),
      faults_(std::move(faults)),
      on_disconnect_(std::move(on_disconnect)),
      stream_(options),
      boot_s_(bench_->clock()->now_s()),
      worker_([this](std::stop_token stop) { work(stop); }) {}

GigeExposures::~GigeExposures() { finish(); }

void GigeExposures::finish() {
  worker_.request_stop();
  abort();
  if (worker_.joinable()) worker_.join();
}

// A second after the start already: no client may think that time zero means no time.
std::uint64_t GigeExposures::now_ns() const {
  return static_cast<std::uint64_t>((bench_->clock()->now_s() - boot_s_ + 1.0) * 1e9);
}

void GigeExposures::trigger(const ExposureOrder& order) {
  const std::lock_guard lock(mutex_);
  if (exposing_ || waiting_ || wedged_) return;
  waiting_ = order;
  wake_.notify_all();
}

void GigeExposures::abort() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  wedged_ = false;
  current_.request_stop();
}

void GigeExposures::boot() {
  abort();
  const std::lock_guard lock(mutex_);
  boot_s_ = bench_->clock()->now_s();
  asked_.clear();
  previous_.reset();
  last_frame_.reset();
  last_block_ = 0;
  stream_.forget();
}

void GigeExposures::work(std::stop_token stop) {
  while (!stop.stop_requested()) {
    ExposureOrder order;
    std::stop_token aborted;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return waiting_.has_value(); })) return;
      order = *waiting_;
      waiting_.reset();
      exposing_ = true;
      current_ = std::stop_source();
      aborted = current_.get_token();
    }
    try {
      carry_out(order, aborted);
    } catch (const Cancelled&) {
      // aborted: there is no frame
    }
    const std::lock_guard lock(mutex_);
    exposing_ = false;
  }
}

// Settings land late: a frame is taken with those of so many triggers ago.
CameraSettings GigeExposures::landed(const CameraSettings& asked) {
  const auto late = static_cast<std::size_t>(options_.settings_latency_frames);
  asked_.push_back(asked);
  while (asked_.size() > late + 1) asked_.pop_front();
  return asked_.front();
}

Fault GigeExposures::choose_fault(const ExposureOrder& order) {
  std::vector<Fault> possible{Fault::Disconnect, Fault::LosePackets, Fault::ReorderPackets, Fault::Wedge};
  if (order.chunk_mask != 0) possible.push_back(Fault::FalseMetadata);
  if (previous_ && *previous_ != order.settings) possible.push_back(Fault::LateSettings);
  if (last_frame_) possible.push_back(Fault::StaleFrame);
  return faults_->next("camera", "frame", possible);
}

void GigeExposures::carry_out(const ExposureOrder& order, std::stop_token stop) {
  Fault fault;
  CameraSettings settings;
  {
    const std::lock_guard lock(mutex_);
    fault = choose_fault(order);
    wedged_ = fault == Fault::Wedge;
    settings = landed(order.settings);
    if (fault == Fault::LateSettings) settings = *previous_;
    previous_ = settings;
  }
  if (fault == Fault::Disconnect) on_disconnect_();
  if (fault == Fault::Disconnect || fault == Fault::Wedge) return;
  const std::uint64_t timestamp_ns = now_ns();
  const BenchExposure exposure = bench_->expose(settings, order.frame_name, stop);
  // The fault says so; only the lateness that the description can declare may lie.
  const bool from_registers = options_.metadata_from_registers && fault != Fault::LateSettings;
  CameraSettings claimed = from_registers ? order.settings : settings;
  if (fault == Fault::FalseMetadata) claimed.exposure_s *= kFalseExposureFactor;
  auto frame = frame_of(order, exposure, claimed, timestamp_ns);
  deliver(std::move(frame), fault, stop);
}

std::shared_ptr<StreamFrame> GigeExposures::frame_of(const ExposureOrder& order, const BenchExposure& exposure,
                                                     const CameraSettings& claimed, std::uint64_t timestamp_ns) {
  const int sensor_width_px = bench_->camera().limits.width_px;
  auto frame = std::make_shared<StreamFrame>();
  {
    const std::lock_guard lock(mutex_);
    last_block_ = last_block_ == 0xffff ? std::uint16_t{1} : static_cast<std::uint16_t>(last_block_ + 1);
    frame->block_id = last_block_;
  }
  frame->timestamp_ns = timestamp_ns;
  frame->pixel_format = order.format.code;
  frame->width_px = order.width_px;
  frame->height_px = order.height_px;
  frame->offset_x_px = order.offset_x_px;
  frame->offset_y_px = order.offset_y_px;
  frame->packet_size = order.packet_size;
  frame->to = order.to;
  frame->chunks = order.chunk_mask != 0;
  frame->payload = packed(order.format, region_of(order, exposure.samples, sensor_width_px));
  if (!frame->chunks) return frame;
  const auto image_bytes = static_cast<std::uint32_t>(frame->payload.size());
  append_be32(frame->payload, kImageChunkId);
  append_be32(frame->payload, image_bytes);
  const std::array<std::uint64_t, kChunkCount> values{std::bit_cast<std::uint64_t>(claimed.exposure_s * 1e6),
                                                      std::bit_cast<std::uint64_t>(claimed.gain_db), order.frame_name,
                                                      timestamp_ns, frame->block_id};
  for (unsigned chunk = 0; chunk < kChunkCount; ++chunk) {
    if (order.chunk_mask >> chunk & 1u) append_chunk(frame->payload, kFirstChunkId + chunk, values[chunk]);
  }
  return frame;
}

void GigeExposures::deliver(std::shared_ptr<StreamFrame> frame, Fault fault, std::stop_token stop) {
  std::shared_ptr<StreamFrame> sent = frame;
  {
    const std::lock_guard lock(mutex_);
    exposing_ = false;  // the next exposure may begin while this frame goes out
    if (stop.stop_requested()) return;
    if (fault == Fault::StaleFrame && last_frame_) {
      sent = std::make_shared<StreamFrame>(*last_frame_);
      sent->to = frame->to;
      if (faults_->detail() < 0.5) sent->block_id = frame->block_id;
    } else {
      last_frame_ = frame;
    }
  }
  Disturbance disturbance;
  if (fault == Fault::LosePackets) disturbance.loss = kLostByFault;
  if (fault == Fault::ReorderPackets) disturbance.reorder = kReorderedByFault;
  stream_.send(sent, disturbance, stop);
  ++frames_sent_;
}

}  // namespace lumitexel::gige
