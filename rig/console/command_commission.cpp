#include <filesystem>
#include <memory>
#include <sstream>

#include "drivers/error.h"
#include "rig/commission/commission_rig.h"
#include "rig/commission/measured_rig.h"
#include "rig/console/command.h"
#include "rig/console/commission_page.h"
#include "rig/console/output_file.h"
#include "rig/console/rig_backend.h"
#include "rig/rig_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct CommissionOptions {
  std::string rig, out, page;
};

nlohmann::json json_of(const Measured& measured) { return {{"value", measured.value}, {"sigma", measured.sigma}}; }

nlohmann::json json_of(const SensorFindings& sensor);

// null for what was not measured.
template <class Finding>
nlohmann::json json_of(const std::optional<Finding>& finding) {
  return finding ? json_of(*finding) : nlohmann::json(nullptr);
}

nlohmann::json json_of(const std::vector<CurvePoint>& curve) {
  nlohmann::json points = nlohmann::json::array();
  for (const CurvePoint& point : curve) points.push_back({point.x, point.y});
  return points;
}

nlohmann::json json_of(const SensorFindings& sensor) {
  return {{"black_level_dn", json_of(sensor.black_level_dn)},
          {"read_noise_dn", json_of(sensor.read_noise_dn)},
          {"read_noise_e", json_of(sensor.read_noise_e)},
          {"electrons_per_dn", json_of(sensor.electrons_per_dn)},
          {"saturation_dn", json_of(sensor.saturation_dn)},
          {"full_well_e", json_of(sensor.full_well_e)},
          {"dark_current_e_per_s", json_of(sensor.dark_current_e_per_s)},
          {"hot_pixel_share", sensor.hot_pixel_share},
          {"nonlinearity_percent", sensor.nonlinearity_percent},
          {"lamp_instability_percent", sensor.lamp_instability_percent},
          {"linearity", json_of(sensor.linearity)},
          {"photon_transfer", json_of(sensor.photon_transfer)}};
}

nlohmann::json json_of(const TimingFindings& timing) {
  nlohmann::json json{{"settings_latency_frames", nullptr},
                      {"honest_late_frames", timing.honest_late_frames},
                      {"frame_overhead_s", json_of(timing.frame_overhead_s)},
                      {"slowest_overhead_s", timing.slowest_overhead_s},
                      {"clock_drift_ppm", json_of(timing.clock_drift_ppm)},
                      {"clock_jitter_s", timing.clock_jitter_s}};
  if (timing.settings_latency_frames) json["settings_latency_frames"] = *timing.settings_latency_frames;
  return json;
}

nlohmann::json json_of(const AxisFindings& axis) {
  return {{"axis", axis.axis},
          {"backlash_deg", json_of(axis.backlash)},
          {"settle_s", axis.settle_s},
          {"repeatability_deg", axis.repeatability},
          {"resolution_deg", axis.resolution},
          {"settling", json_of(axis.settling)}};
}

void line(std::ostream& out, const char* what, const Measured& measured, const char* unit, double described) {
  out << "  " << what << ": " << measured.value << " +- " << measured.sigma << ' ' << unit << "  (described: " << described
      << ")\n";
}

void put_sensor(std::ostream& out, const SensorFindings& sensor, const SensorDescription& described) {
  out << "camera\n";
  line(out, "black level", sensor.black_level_dn, "DN", described.black_level_dn);
  line(out, "gain", sensor.electrons_per_dn, "e/DN", described.electrons_per_dn);
  line(out, "read noise", sensor.read_noise_e, "e", described.read_noise_e);
  if (sensor.full_well_e) line(out, "full well", *sensor.full_well_e, "e", described.full_well_e);
  out << "  dark current: " << sensor.dark_current_e_per_s.value << " +- " << sensor.dark_current_e_per_s.sigma
      << " e/s; hot pixels: " << 100.0 * sensor.hot_pixel_share << " %\n"
      << "  non-linearity: " << sensor.nonlinearity_percent << " % of the signal at most\n"
      << "  point light, frame to frame: " << sensor.lamp_instability_percent << " %\n";
}

std::string text_of(const CommissionReport& report, const RigDescription& rig) {
  std::ostringstream out;
  out.precision(4);
  if (report.sensor) put_sensor(out, *report.sensor, rig.camera.sensor);
  out << "timing\n";
  if (report.timing.settings_latency_frames) {
    out << "  settings land " << *report.timing.settings_latency_frames << " frames late, "
        << report.timing.honest_late_frames << " of them say so\n";
  }
  out << "  a frame takes its exposure and "
      << report.timing.frame_overhead_s.value << " s, at most " << report.timing.slowest_overhead_s << " s (described: "
      << rig.camera.limits.readout_s << ")\n";
  if (report.timing.clock_drift_ppm) {
    out << "  camera clock: " << report.timing.clock_drift_ppm->value << " +- " << report.timing.clock_drift_ppm->sigma
        << " ppm against this machine's, jitter " << report.timing.clock_jitter_s << " s\n";
  }
  for (const AxisFindings& axis : report.axes) {
    out << axis.axis << "\n  backlash " << axis.backlash.value << " +- " << axis.backlash.sigma
        << " deg; returns to " << axis.repeatability << " deg; one picture tells " << axis.resolution
        << " deg apart\n  stands " << axis.settle_s << " s after its encoder says so\n";
  }
  out << "not checked\n";
  for (const std::string& what : report.not_checked) out << "  " << what << '\n';
  return out.str();
}

// Beside the rig's own file `base` is a name; from elsewhere a whole path.
std::string base_for(const fs::path& rig, const fs::path& out) {
  const fs::path whole = fs::weakly_canonical(rig), folder = fs::weakly_canonical(fs::absolute(out)).parent_path();
  return whole.parent_path() == folder ? whole.filename().string() : whole.string();
}

// Before minutes of measuring.
void require_new_file(const std::string& option, const fs::path& file) {
  if (file.empty()) return;
  if (fs::exists(file)) throw BadInput(option, file.string() + " is there already", "a new file's name");
  require_writable_folder(option, file);
}

CommandResult run(const CommissionOptions& options, CommandContext& context) {
  require_new_file("--out", options.out);
  require_new_file("--page", options.page);
  const RigDescription rig = parse_rig(read_rig_file(options.rig), options.rig);
  const RigBackend backend = rig_backend(commissioning_description(rig), options.rig);
  RigDevices devices = backend.connect(context.stop);
  const CommissionReport report = commission_rig(devices, rig, context.progress, context.stop);
  CommandResult result;
  result.json = {{"rig", rig.name},        {"backend", rig.backend}, {"sensor", json_of(report.sensor)},
                 {"timing", json_of(report.timing)}, {"axes", nlohmann::json::array()},
                 {"not_checked", report.not_checked}, {"seconds", report.seconds}};
  for (const AxisFindings& axis : report.axes) result.json["axes"].push_back(json_of(axis));
  result.text = text_of(report, rig);
  if (!options.out.empty()) {
    write_whole_file(options.out, measured_rig_toml(report, rig, base_for(options.rig, options.out)));
    result.json["out"] = options.out;
    result.text += "\nthe measured rig: " + options.out + "\n";
  }
  if (!options.page.empty()) {
    write_whole_file(options.page, commission_page(report, rig, result.json.dump(1)));
    result.json["page"] = options.page;
    result.text += "curves: " + options.page + "\n";
  }
  return result;
}

}  // namespace

void add_commission_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<CommissionOptions>();
  Command command(app, "commission", "Measure a connected rig: latency, linearity, noise, settling, backlash, clocks; write what it is");
  command.add_option("RIG", options->rig, "Rig description, TOML").required();
  command.add_option("--out", options->out, "Write the measured description here: a rig file that builds on RIG");
  command.add_option("--page", options->page, "Write numbers and curves here: one offline HTML page");
  command.footer("Put something with visible detail on the turntable, in the point light. Nothing is stored but --out and --page.");
  command.callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
