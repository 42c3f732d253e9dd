// The simulated camera's settings as PTP device properties.
//
// Exposures are whole tenths of a millisecond on the wire (property 500D). A rig's exposure_choices_s that are not, or
// that lie below 0.1 ms, are refused when the camera is made, not rounded. libgphoto2 2.5.30 turns a choice's text into
// a count by cutting, not rounding, and takes the nearest choice: choices one count apart may be mistaken for each
// other there, which the driver notices when it reads back.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/camera.h"
#include "sim/protocol/ptp/ptp_codes.h"

namespace lumitexel::ptp {

class CameraProperties {
 public:
  // Exposures are limits.exposure_choices_s, or a dial in thirds of stops from 1/1000 s to 30 s, as far as it lies
  // within the limits; so are ISO values, where gain_db = 20 log10(iso / iso_at_0_db). Throws BadInput if a choice of
  // exposure is no whole number of tenths of milliseconds, or if no exposure or no ISO value is left.
  CameraProperties(const CameraLimits& limits, const std::vector<int>& iso_choices, double iso_at_0_db);

  std::vector<std::uint16_t> codes() const;
  // The data set of GetDevicePropDesc or GetDevicePropValue; empty for a property that there is not.
  std::optional<std::vector<std::uint8_t>> description(std::uint16_t code) const;
  std::optional<std::vector<std::uint8_t>> value(std::uint16_t code) const;
  // Throws Protocol for a data set that ends too early.
  Response set(std::uint16_t code, const std::vector<std::uint8_t>& data);

  std::uint32_t number(Property property) const;
  const std::string& text(Property property) const;
  const std::vector<std::uint32_t>& choices(Property property) const;
  // What a picture taken now is taken with.
  CameraSettings settings() const;

 private:
  struct Entry {
    std::uint16_t type = kUint16;
    bool writable = true;
    std::uint32_t number = 0;
    std::string text;
    std::vector<std::uint32_t> choices;  // an enumeration; empty: any value
  };
  const Entry& entry(Property property) const { return entries_.at(static_cast<std::uint16_t>(property)); }
  Entry& entry(Property property) { return entries_[static_cast<std::uint16_t>(property)]; }

  double iso_at_0_db_;
  std::map<std::uint16_t, Entry> entries_;
};

}  // namespace lumitexel::ptp
