#include "sim/protocol/gige/gige_camera_server.h"

#include <vector>

#include "sim/protocol/gige/camera_registers.h"
#include "sim/protocol/gige/gige_exposures.h"
#include "sim/protocol/gige/gvcp_control.h"

namespace lumitexel {

using namespace gige;

// Registers that do something when they are written.
class GigeCameraServer::Device final : public GvcpTarget {
 public:
  Device(std::shared_ptr<SimulatedBench> bench, const GigeCameraOptions& options, std::shared_ptr<FaultSource> faults)
      : options_(options),
        faults_(faults),
        registers_(bench->camera().limits, options, bench->behaviour().sensor_temperature_c),
        exposures_(std::move(bench), options, faults, [this] { disconnect(); }),
        control_(options, std::move(faults), *this) {
    control_.start();
  }
  // The exposing thread may still ask the control channel to disconnect.
  ~Device() override { exposures_.finish(); }

  Status read(std::uint32_t address, std::size_t size, std::vector<std::uint8_t>& bytes) override {
    return registers_.read(address, size, bytes);
  }

  Status write(std::uint32_t address, std::span<const std::uint8_t> bytes) override {
    const Status status = registers_.write(address, bytes);
    if (status != Status::Success) return status;
    RegisterBlock& block = registers_.block();
    switch (address) {
      case kAcquisitionStart: registers_.set_acquiring(true); break;
      case kAcquisitionStop: control_ended_or_stopped(); break;
      case kControlPrivilege: exposures_.abort(); break;
      case kTimestampControl:
        if (options_.timestamp_latch && (block.get32(address) & 2u)) block.set64(kTimestampValue, exposures_.now_ns());
        break;
      case kTriggerSoftware: trigger(); break;
      case kPacketSize: send_test_packet(); break;
      default: break;
    }
    return status;
  }

  void resend(std::uint16_t block_id, std::uint32_t first, std::uint32_t last) override {
    exposures_.stream().resend(block_id, first, last);
  }
  void control_ended() override {
    registers_.block().set32(kControlPrivilege, 0);
    control_ended_or_stopped();
  }
  void reboot() override {
    registers_.boot();
    exposures_.boot();
  }
  std::uint32_t heartbeat_timeout_ms() const override { return registers_.block().get32(kHeartbeatTimeout_ms); }

  const GigeCameraOptions& options() const { return options_; }
  GvcpControl& control() { return control_; }
  GigeExposures& exposures() { return exposures_; }

 private:
  void control_ended_or_stopped() {
    registers_.set_acquiring(false);
    exposures_.abort();
  }

  void trigger() {
    const RegisterBlock& block = registers_.block();
    if (!registers_.acquiring() || block.get32(kTriggerMode) == 0 || block.get32(kTriggerSource) != 0) return;
    ExposureOrder order;
    order.settings = registers_.settings();
    order.frame_name = block.get64(kFrameName);
    order.format = registers_.pixel_format();
    order.width_px = block.get32(kWidth);
    order.height_px = block.get32(kHeight);
    order.offset_x_px = block.get32(kOffsetX);
    order.offset_y_px = block.get32(kOffsetY);
    order.packet_size = registers_.packet_size();
    order.chunk_mask = registers_.chunk_mask();
    order.to = registers_.stream_destination();
    exposures_.trigger(order);
  }

  // The highest bit of the register asks for it; "do not fragment" (the next one) is kept.
  void send_test_packet() {
    const std::uint32_t value = registers_.block().get32(kPacketSize);
    registers_.block().set32(kPacketSize, value & 0x4000ffffu);
    if (value & 0x80000000u) {
      exposures_.stream().send_test_packet(registers_.packet_size(), registers_.stream_destination());
    }
  }

  void disconnect() {
    if (faults_->detail() < 0.5) {
      control_.withdraw_control();
    } else {
      control_.reboot();
    }
  }

  GigeCameraOptions options_;
  std::shared_ptr<FaultSource> faults_;
  CameraRegisters registers_;
  GigeExposures exposures_;
  GvcpControl control_;  // the last member: its thread ends before what it serves
};

GigeCameraServer::GigeCameraServer(std::shared_ptr<SimulatedBench> bench, const GigeCameraOptions& options,
                                   std::shared_ptr<FaultSource> faults)
    : device_(std::make_unique<Device>(std::move(bench), options, std::move(faults))) {}

GigeCameraServer::~GigeCameraServer() = default;

const std::string& GigeCameraServer::address() const { return device_->options().address; }
void GigeCameraServer::withdraw_control() { device_->control().withdraw_control(); }
void GigeCameraServer::reboot() { device_->control().reboot(); }
std::uint64_t GigeCameraServer::frames_sent() const { return device_->exposures().frames_sent(); }
std::uint64_t GigeCameraServer::packets_lost() const { return device_->exposures().stream().packets_lost(); }
std::uint64_t GigeCameraServer::packets_resent() const { return device_->exposures().stream().packets_resent(); }

}  // namespace lumitexel
