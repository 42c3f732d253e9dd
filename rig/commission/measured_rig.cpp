#include "rig/commission/measured_rig.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace lumitexel {
namespace {

constexpr double kSettleMargin = 1.2, kLeastSettle_s = 0.05;

// A basic TOML string.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

void put(std::ostream& out, const char* key, const Measured& measured, const char* what) {
  out << key << " = " << measured.value;
  if (measured.value == std::floor(measured.value)) out << ".0";
  out << "  # +- " << measured.sigma << (*what ? ", " : "") << what << '\n';
}

void put_settle(std::ostream& out, const char* table, double settled_s, const std::string& what) {
  out << "\n[" << table << "]\nsettle_s = " << std::max(kLeastSettle_s, kSettleMargin * settled_s) << "  # " << what
      << ": pictures stand " << settled_s << " s after the encoder; a fifth added, at least " << kLeastSettle_s << '\n';
}

}  // namespace

std::string measured_rig_toml(const CommissionReport& report, const RigDescription& rig, const std::string& base) {
  std::ostringstream out;
  out.precision(6);
  out << "# Measured by `lumitexel commission`. Numbers after +- are one sigma.\n"
      << "base = " << quoted(base) << "\nname = " << quoted(rig.name + ", measured") << "\n\n[camera]\n";
  if (report.timing.settings_latency_frames) {
    out << "settings_latency_frames = " << *report.timing.settings_latency_frames << '\n';
  }
  put(out, "readout_s", {std::max(0.0, report.timing.frame_overhead_s.value), report.timing.frame_overhead_s.sigma},
      "trigger to frame, less the exposure");
  if (report.sensor) {
    const SensorFindings& sensor = *report.sensor;
    put(out, "electrons_per_dn", sensor.electrons_per_dn, "photon transfer");
    if (sensor.full_well_e) put(out, "full_well_e", *sensor.full_well_e, "");
    put(out, "read_noise_e", sensor.read_noise_e, "");
    put(out, "black_level_dn", sensor.black_level_dn, "");
  }
  double arm_s = -1.0;
  for (const AxisFindings& axis : report.axes) {
    out << "# " << axis.axis << ": slack " << axis.backlash.value << " +- " << axis.backlash.sigma
        << " deg; no key of a rig takes it: approach from one side where it matters\n";
    if (axis.axis == "turntable") put_settle(out, "turntable", axis.settle_s, "the table");
    else arm_s = std::max(arm_s, axis.settle_s);
  }
  if (arm_s >= 0.0) put_settle(out, "light_positioner", arm_s, "the slower of its two axes");
  return out.str();
}

}  // namespace lumitexel
