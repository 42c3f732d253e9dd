// Where the simulated GigE Vision camera keeps what: the standard's bootstrap registers, and its own features. Every
// register is big-endian, as the standard has it.
#pragma once

#include <cstdint>

namespace lumitexel::gige {

// Bootstrap registers.
inline constexpr std::uint32_t kVersion = 0x0000, kDeviceMode = 0x0004, kMacHigh = 0x0008, kMacLow = 0x000c,
                               kCurrentIp = 0x0024, kSubnetMask = 0x0034, kVendorName = 0x0048, kModelName = 0x0068,
                               kDeviceVersion = 0x0088, kManufacturerInfo = 0x00a8, kSerialNumber = 0x00d8,
                               kUserName = 0x00e8, kDiscoveryEnd = 0x00f8, kFirstUrl = 0x0200,
                               kInterfaceCount = 0x0600, kStreamChannelCount = 0x0904, kGvcpCapability = 0x0934,
                               kHeartbeatTimeout_ms = 0x0938, kTimestampTickFrequency = 0x093c,
                               kTimestampControl = 0x0944, kTimestampValue = 0x0948, kControlPrivilege = 0x0a00,
                               kStreamPort = 0x0d00, kPacketSize = 0x0d04, kPacketDelay = 0x0d08,
                               kStreamDestination = 0x0d18;

// Features. Eight bytes each: ExposureTime, Gain, DeviceTemperature (doubles) and FrameName (integer).
inline constexpr std::uint32_t kWidth = 0xa000, kHeight = 0xa004, kOffsetX = 0xa008, kOffsetY = 0xa00c,
                               kPixelFormat = 0xa010, kPayloadSize = 0xa014, kSensorWidth = 0xa018,
                               kSensorHeight = 0xa01c, kAcquisitionMode = 0xa020, kAcquisitionStart = 0xa024,
                               kAcquisitionStop = 0xa028, kParametersLocked = 0xa02c, kTriggerSelector = 0xa030,
                               kTriggerMode = 0xa034, kTriggerSource = 0xa038, kTriggerSoftware = 0xa03c,
                               kExposureTime_us = 0xa040, kGain_db = 0xa048, kTemperature_c = 0xa050,
                               kFrameName = 0xa058, kChunkModeActive = 0xa060, kChunkSelector = 0xa064,
                               kSignificantBits = 0xa068, kChunkEnable = 0xa070;  // kChunkEnable: one per chunk
inline constexpr std::uint32_t kRegisterSpace = 0xb000, kDescriptionAddress = 0x10000;

// The chunks in the order of ChunkSelector's values; their ids in the payload.
enum class Chunk { ExposureTime, Gain, FrameName, Timestamp, FrameId };
inline constexpr int kChunkCount = 5;
inline constexpr std::uint32_t kImageChunkId = 1, kFirstChunkId = 0x2001;

// What a GVCP acknowledgement says.
enum class Status : std::uint16_t {
  Success = 0,
  NotImplemented = 0x8001,
  InvalidParameter = 0x8002,
  InvalidAddress = 0x8003,
  WriteProtect = 0x8004,
  AccessDenied = 0x8006,
  Busy = 0x8007,
};

}  // namespace lumitexel::gige
