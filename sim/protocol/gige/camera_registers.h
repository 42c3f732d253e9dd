// The simulated camera's memory: what its registers hold after power on, which writes it takes, and what they mean.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera.h"
#include "sim/protocol/gige/gige_camera_options.h"
#include "sim/protocol/gige/gige_registers.h"
#include "sim/protocol/gige/pixel_packing.h"
#include "sim/protocol/gige/register_block.h"

namespace lumitexel::gige {

class CameraRegisters {
 public:
  // sensor: the limits of the whole sensor.
  CameraRegisters(const CameraLimits& sensor, const GigeCameraOptions& options, double temperature_c);

  void boot();  // everything as after power on

  // Appends `size` bytes. The description lies behind the registers.
  Status read(std::uint32_t address, std::size_t size, std::vector<std::uint8_t>& bytes) const;
  // Takes a whole register or nothing. Image and stream registers are closed while acquiring.
  Status write(std::uint32_t address, std::span<const std::uint8_t> bytes);

  RegisterBlock& block() { return block_; }
  const RegisterBlock& block() const { return block_; }
  bool acquiring() const { return acquiring_; }
  void set_acquiring(bool acquiring) { acquiring_ = acquiring; }
  CameraSettings settings() const;
  PixelFormat pixel_format() const;
  std::uint32_t packet_size() const { return block_.get32(kPacketSize) & 0xffff; }
  sockaddr_in stream_destination() const;
  unsigned chunk_mask() const;  // bit per Chunk; 0: no chunks at all

 private:
  void boot_standard();
  void boot_features();
  Status check(std::uint32_t address, std::span<const std::uint8_t> bytes) const;
  Status check_image(std::uint32_t address, std::uint32_t value) const;
  double stored(std::uint32_t address, double value) const;
  void update_payload_size();

  CameraLimits sensor_;
  GigeCameraOptions options_;
  double temperature_c_;
  std::string description_;
  RegisterBlock block_{kRegisterSpace};
  bool acquiring_ = false;
};

}  // namespace lumitexel::gige
