#include "sim/protocol/gige/camera_registers.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <sstream>

#include "sim/protocol/gige/genicam_description.h"

namespace lumitexel::gige {
namespace {

// Big-endian, UTF-8.
constexpr std::uint32_t kBigEndianDevice = 0x80000001;
// Several registers a command, write memory, packet resend, a serial number, a user's name.
constexpr std::uint32_t kCapability = 0x1 | 0x2 | 0x4 | 0x40000000 | 0x80000000;
constexpr std::uint64_t kTicksPerSecond = 1'000'000'000;
constexpr std::uint32_t kSmallestPacket = 576;

constexpr std::array kImageRegisters{kWidth, kHeight, kOffsetX, kOffsetY, kPixelFormat, kChunkModeActive};
constexpr std::array kFreeRegisters{kHeartbeatTimeout_ms, kTimestampControl, kControlPrivilege, kStreamPort,
                                    kPacketSize,          kPacketDelay,      kStreamDestination, kAcquisitionMode,
                                    kAcquisitionStart,    kAcquisitionStop,  kParametersLocked,  kTriggerSelector,
                                    kTriggerMode,         kTriggerSource,    kTriggerSoftware,   kChunkSelector};

template <std::size_t N>
bool is_one_of(const std::array<std::uint32_t, N>& addresses, std::uint32_t address) {
  return std::find(addresses.begin(), addresses.end(), address) != addresses.end();
}

bool is_chunk_enable(std::uint32_t address) {
  return address >= kChunkEnable && address < kChunkEnable + 4 * kChunkCount && address % 4 == 0;
}

double double_of(std::span<const std::uint8_t> bytes) {
  return std::bit_cast<double>(std::uint64_t{be32(bytes)} << 32 | be32(bytes.subspan(4)));
}

}  // namespace

CameraRegisters::CameraRegisters(const CameraLimits& sensor, const GigeCameraOptions& options, double temperature_c)
    : sensor_(sensor),
      options_(options),
      temperature_c_(temperature_c),
      description_(genicam_description(sensor, options)) {
  boot();
}

void CameraRegisters::boot() {
  block_ = RegisterBlock(kRegisterSpace);
  acquiring_ = false;
  boot_standard();
  boot_features();
}

void CameraRegisters::boot_standard() {
  const std::uint32_t ip = ntohl(inet_addr(options_.address.c_str()));
  block_.set32(kVersion, 0x00020000);
  block_.set32(kDeviceMode, kBigEndianDevice);
  block_.set32(kMacHigh, 0x0200);  // an address of nobody's
  block_.set32(kMacLow, ip);
  block_.set32(kCurrentIp, ip);
  block_.set32(kSubnetMask, 0xff000000);
  block_.set_text(kVendorName, 32, options_.vendor);
  block_.set_text(kModelName, 32, options_.model);
  block_.set_text(kDeviceVersion, 32, "1.0");
  block_.set_text(kManufacturerInfo, 48, "simulated");
  block_.set_text(kSerialNumber, 16, options_.serial);
  std::ostringstream url;
  url << "Local:camera.xml;" << std::hex << kDescriptionAddress << ';' << description_.size();
  block_.set_text(kFirstUrl, 512, url.str());
  block_.set32(kInterfaceCount, 1);
  block_.set32(kStreamChannelCount, 1);
  block_.set32(kGvcpCapability, kCapability);
  block_.set32(kHeartbeatTimeout_ms, 3000);
  block_.set64(kTimestampTickFrequency, kTicksPerSecond);
  block_.set32(kPacketSize, 1500);
}

void CameraRegisters::boot_features() {
  block_.set32(kSensorWidth, static_cast<std::uint32_t>(sensor_.width_px));
  block_.set32(kSensorHeight, static_cast<std::uint32_t>(sensor_.height_px));
  block_.set32(kWidth, static_cast<std::uint32_t>(sensor_.width_px));
  block_.set32(kHeight, static_cast<std::uint32_t>(sensor_.height_px));
  block_.set32(kPixelFormat, pixel_formats(sensor_.mosaic, sensor_.bits).front().code);
  block_.set32(kSignificantBits, static_cast<std::uint32_t>(sensor_.bits));
  block_.set_double(kExposureTime_us, stored(kExposureTime_us, std::max(sensor_.exposure_min_s, 1e-3) * 1e6));
  block_.set_double(kGain_db, lowest_gain_db(sensor_));
  block_.set_double(kTemperature_c, temperature_c_);
  update_payload_size();
}

Status CameraRegisters::read(std::uint32_t address, std::size_t size, std::vector<std::uint8_t>& bytes) const {
  if (address + size <= block_.size()) {
    const auto part = block_.read(address, size);
    bytes.insert(bytes.end(), part.begin(), part.end());
    return Status::Success;
  }
  if (address < kDescriptionAddress || address >= kDescriptionAddress + description_.size()) {
    return Status::InvalidAddress;
  }
  // Clients read whole words, beyond the text's end.
  const std::string part = description_.substr(address - kDescriptionAddress, size);
  bytes.insert(bytes.end(), part.begin(), part.end());
  bytes.resize(bytes.size() + size - part.size());
  return Status::Success;
}

// A camera applies what it can: the nearest step of its exposure.
double CameraRegisters::stored(std::uint32_t address, double value) const {
  const double step = address == kExposureTime_us ? sensor_.exposure_step_s * 1e6 : sensor_.gain_step_db;
  return step > 0.0 ? std::round(value / step) * step : value;
}

Status CameraRegisters::check_image(std::uint32_t address, std::uint32_t value) const {
  if (acquiring_) return Status::WriteProtect;
  const auto sum = [&](std::uint32_t size_at, std::uint32_t offset_at) {
    return std::uint64_t{address == size_at ? value : block_.get32(size_at)} +
           (address == offset_at ? value : block_.get32(offset_at));
  };
  if (address == kPixelFormat) {
    const auto formats = pixel_formats(sensor_.mosaic, sensor_.bits);
    const bool known = std::any_of(formats.begin(), formats.end(), [&](const auto& f) { return f.code == value; });
    return known ? Status::Success : Status::InvalidParameter;
  }
  if (address == kChunkModeActive) return options_.chunks ? Status::Success : Status::InvalidAddress;
  const bool fits = sum(kWidth, kOffsetX) <= block_.get32(kSensorWidth) &&
                    sum(kHeight, kOffsetY) <= block_.get32(kSensorHeight);
  const bool empty = value == 0 && (address == kWidth || address == kHeight);
  return fits && !empty && value % 2 == 0 ? Status::Success : Status::InvalidParameter;
}

Status CameraRegisters::check(std::uint32_t address, std::span<const std::uint8_t> bytes) const {
  if (address == kExposureTime_us || address == kGain_db) {
    if (bytes.size() != 8) return Status::InvalidParameter;
    const double value = double_of(bytes);
    const bool good = address == kGain_db ? value >= lowest_gain_db(sensor_) && value <= highest_gain_db(sensor_)
                                          : value >= sensor_.exposure_min_s * 1e6 * (1 - 1e-9) &&
                                                value <= sensor_.exposure_max_s * 1e6 * (1 + 1e-9);
    return good ? Status::Success : Status::InvalidParameter;
  }
  if (address == kFrameName) return bytes.size() == 8 ? Status::Success : Status::InvalidParameter;
  if (bytes.size() != 4) return Status::InvalidParameter;
  if (is_one_of(kImageRegisters, address)) return check_image(address, be32(bytes));
  if (is_chunk_enable(address)) return acquiring_ ? Status::WriteProtect : Status::Success;
  if (address == kPacketSize && (be32(bytes) & 0xffff) < kSmallestPacket) return Status::InvalidParameter;
  if (is_one_of(kFreeRegisters, address)) return Status::Success;
  return address < block_.size() ? Status::WriteProtect : Status::InvalidAddress;
}

Status CameraRegisters::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  const Status status = check(address, bytes);
  if (status != Status::Success) return status;
  if (address == kExposureTime_us || address == kGain_db) {
    block_.set_double(address, stored(address, double_of(bytes)));
  } else {
    block_.write(address, bytes);
  }
  update_payload_size();
  return Status::Success;
}

// To the last bit what the rig means by these settings, whatever microseconds did to them: the bench's noise depends on it.
CameraSettings CameraRegisters::settings() const {
  CameraLimits gains = sensor_;
  gains.gain_min_db = lowest_gain_db(sensor_);
  gains.gain_max_db = highest_gain_db(sensor_);
  return quantise({std::clamp(block_.get_double(kExposureTime_us) * 1e-6, sensor_.exposure_min_s, sensor_.exposure_max_s),
                   std::clamp(block_.get_double(kGain_db), gains.gain_min_db, gains.gain_max_db)},
                  gains, "simulated camera");
}

PixelFormat CameraRegisters::pixel_format() const {
  for (const PixelFormat& format : pixel_formats(sensor_.mosaic, sensor_.bits)) {
    if (format.code == block_.get32(kPixelFormat)) return format;
  }
  return {};
}

sockaddr_in CameraRegisters::stream_destination() const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(block_.get32(kStreamPort)));
  to.sin_addr.s_addr = htonl(block_.get32(kStreamDestination));
  return to;
}

unsigned CameraRegisters::chunk_mask() const {
  if (!options_.chunks || block_.get32(kChunkModeActive) == 0) return 0;
  unsigned mask = 0;
  for (unsigned chunk = 0; chunk < kChunkCount; ++chunk) {
    if (block_.get32(kChunkEnable + 4 * chunk) != 0) mask |= 1u << chunk;
  }
  return mask;
}

void CameraRegisters::update_payload_size() {
  const std::size_t pixels = std::size_t{block_.get32(kWidth)} * block_.get32(kHeight);
  std::size_t bytes = packed_bytes(pixel_format(), pixels);
  const unsigned mask = chunk_mask();
  // Each chunk is followed by its id and size; so is the image, as soon as there are chunks.
  if (mask != 0) bytes += 8 + 16 * static_cast<std::size_t>(std::popcount(mask));
  block_.set32(kPayloadSize, static_cast<std::uint32_t>(bytes));
}

}  // namespace lumitexel::gige
