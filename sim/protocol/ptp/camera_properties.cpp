#include "sim/protocol/ptp/camera_properties.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "drivers/error.h"
#include "sim/protocol/ptp/dataset.h"

namespace lumitexel::ptp {
namespace {

constexpr double kCountsPerSecond = 1e4;

std::vector<std::uint32_t> dial() {
  return {10,    13,    16,    20,    25,     31,     40,     50,     63,     80,    100,   125,
          167,   200,   250,   333,   400,    500,    667,    769,    1000,   1250,  1667,  2000,
          2500,  3333,  4000,  5000,  6000,   8000,   10000,  13000,  16000,  20000, 25000, 32000,
          40000, 50000, 60000, 80000, 100000, 130000, 150000, 200000, 250000, 300000};
}

std::uint32_t counts_of(double exposure_s) {
  const double counts = std::round(exposure_s * kCountsPerSecond);
  if (counts >= 1.0 && counts < 4e9 && std::abs(counts - exposure_s * kCountsPerSecond) <= 1e-6 * counts) {
    return static_cast<std::uint32_t>(counts);
  }
  std::ostringstream what;
  what << exposure_s << " s";
  throw BadInput("simulated PTP camera: exposure_choices_s", what.str(), "whole multiples of 0.0001 s, at least one");
}

std::vector<std::uint32_t> exposures_within(const CameraLimits& limits) {
  std::vector<std::uint32_t> kept;
  for (const double choice_s : limits.exposure_choices_s) kept.push_back(counts_of(choice_s));
  if (!kept.empty()) return kept;
  for (const std::uint32_t count : dial()) {
    const double exposure_s = count / kCountsPerSecond;
    if (exposure_s >= limits.exposure_min_s && exposure_s <= limits.exposure_max_s) kept.push_back(count);
  }
  if (kept.empty()) throw BadInput("simulated PTP camera", "no exposure of its dial within the limits", "wider limits");
  return kept;
}

std::vector<std::uint32_t> iso_within(const CameraLimits& limits, const std::vector<int>& choices, double iso_at_0_db) {
  std::vector<std::uint32_t> kept;
  for (const int iso : choices) {
    const double gain_db = 20.0 * std::log10(iso / iso_at_0_db);
    if (gain_db >= limits.gain_min_db - 1e-4 && gain_db <= limits.gain_max_db + 1e-4) {
      kept.push_back(static_cast<std::uint32_t>(iso));
    }
  }
  if (kept.empty()) throw BadInput("simulated PTP camera", "no ISO value within the gain's limits", "wider limits");
  return kept;
}

int bytes_of(std::uint16_t type) { return type == kUint8 ? 1 : type == kUint16 ? 2 : 4; }

}  // namespace

CameraProperties::CameraProperties(const CameraLimits& limits, const std::vector<int>& iso_choices, double iso_at_0_db)
    : iso_at_0_db_(iso_at_0_db) {
  const auto exposures = exposures_within(limits);
  const auto isos = iso_within(limits, iso_choices, iso_at_0_db);
  entry(Property::ExposureTime) = {kUint32, true, exposures[exposures.size() / 2], {}, exposures};
  entry(Property::ExposureIndex) = {kUint16, true, isos.front(), {}, isos};
  entry(Property::FNumber) = {kUint16, true, 800, {}, {280, 400, 560, 800, 1100, 1600}};
  entry(Property::ExposureMode) = {kUint16, true, 1, {}, {1}};  // manual, and nothing else
  entry(Property::BatteryLevel) = {kUint8, false, 100, {}, {}};
  entry(Property::DateTime) = {kText, true, 0, "20260101T000000", {}};
  entry(Property::Artist) = {kText, true, 0, "", {}};
}

std::vector<std::uint16_t> CameraProperties::codes() const {
  std::vector<std::uint16_t> codes;
  for (const auto& [code, entry] : entries_) codes.push_back(code);
  return codes;
}

std::optional<std::vector<std::uint8_t>> CameraProperties::value(std::uint16_t code) const {
  const auto found = entries_.find(code);
  if (found == entries_.end()) return {};
  DatasetWriter writer;
  if (found->second.type == kText) return writer.text(found->second.text).take();
  return writer.number(found->second.number, bytes_of(found->second.type)).take();
}

std::optional<std::vector<std::uint8_t>> CameraProperties::description(std::uint16_t code) const {
  const auto current = value(code);
  if (!current) return {};
  const Entry& entry = entries_.at(code);
  DatasetWriter writer;
  writer.u16(code).u16(entry.type).u8(entry.writable ? 1 : 0);
  writer.bytes(*current).bytes(*current);  // its default is what it is
  writer.u8(entry.choices.empty() ? 0 : 2);
  if (!entry.choices.empty()) writer.u16(entry.choices.size());
  for (const std::uint32_t choice : entry.choices) writer.number(choice, bytes_of(entry.type));
  return writer.take();
}

Response CameraProperties::set(std::uint16_t code, const std::vector<std::uint8_t>& data) {
  const auto found = entries_.find(code);
  if (found == entries_.end()) return Response::DevicePropNotSupported;
  Entry& entry = found->second;
  if (!entry.writable) return Response::AccessDenied;
  DatasetReader reader(data);
  if (entry.type == kText) {
    entry.text = reader.text();
    return Response::Ok;
  }
  const auto wanted = static_cast<std::uint32_t>(reader.number(bytes_of(entry.type)));
  if (std::find(entry.choices.begin(), entry.choices.end(), wanted) == entry.choices.end()) {
    return Response::InvalidDevicePropValue;
  }
  entry.number = wanted;
  return Response::Ok;
}

std::uint32_t CameraProperties::number(Property property) const { return entry(property).number; }
const std::string& CameraProperties::text(Property property) const { return entry(property).text; }
const std::vector<std::uint32_t>& CameraProperties::choices(Property property) const { return entry(property).choices; }

CameraSettings CameraProperties::settings() const {
  return {number(Property::ExposureTime) / kCountsPerSecond,
          20.0 * std::log10(number(Property::ExposureIndex) / iso_at_0_db_)};
}

}  // namespace lumitexel::ptp
