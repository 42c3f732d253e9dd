// The numbers of PTP (ISO 15740) and PTP/IP (CIPA DC-005) that the simulated camera knows.
#pragma once

#include <cstdint>

namespace lumitexel::ptp {

enum class PacketType : std::uint32_t {
  InitCommandRequest = 1,
  InitCommandAck = 2,
  InitEventRequest = 3,
  InitEventAck = 4,
  InitFail = 5,
  CommandRequest = 6,
  CommandResponse = 7,
  Event = 8,
  StartData = 9,
  Data = 10,
  EndData = 12,
  Ping = 13,
  Pong = 14
};

enum class Operation : std::uint16_t {
  GetDeviceInfo = 0x1001,
  OpenSession = 0x1002,
  CloseSession = 0x1003,
  GetStorageIds = 0x1004,
  GetStorageInfo = 0x1005,
  GetNumObjects = 0x1006,
  GetObjectHandles = 0x1007,
  GetObjectInfo = 0x1008,
  GetObject = 0x1009,
  DeleteObject = 0x100B,
  InitiateCapture = 0x100E,
  GetDevicePropDesc = 0x1014,
  GetDevicePropValue = 0x1015,
  SetDevicePropValue = 0x1016
};

enum class Response : std::uint16_t {
  Ok = 0x2001,
  GeneralError = 0x2002,
  SessionNotOpen = 0x2003,
  OperationNotSupported = 0x2005,
  InvalidObjectHandle = 0x2009,
  DevicePropNotSupported = 0x200A,
  StoreFull = 0x200C,
  AccessDenied = 0x200F,
  DeviceBusy = 0x2019,
  InvalidDevicePropValue = 0x201C,
  SessionAlreadyOpen = 0x201E
};

enum class EventCode : std::uint16_t { ObjectAdded = 0x4002, CaptureComplete = 0x400D };

enum class Property : std::uint16_t {
  BatteryLevel = 0x5001,  // percent
  FNumber = 0x5007,       // hundredths
  ExposureTime = 0x500D,  // tenths of a millisecond
  ExposureMode = 0x500E,
  ExposureIndex = 0x500F,  // ISO
  DateTime = 0x5011,
  Artist = 0x501E
};

// Data types of properties.
inline constexpr std::uint16_t kUint8 = 0x0002, kUint16 = 0x0004, kUint32 = 0x0006, kText = 0xFFFF;

inline constexpr std::uint32_t kStorageId = 0x00010001;
inline constexpr std::uint16_t kFormatUndefined = 0x3000, kFormatDng = 0x3811;

}  // namespace lumitexel::ptp
