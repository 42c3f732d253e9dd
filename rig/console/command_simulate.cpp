#include <iostream>
#include <map>
#include <memory>
#include <sstream>

#include "drivers/error.h"
#include "processing/surface/mesh_file.h"
#include "rig/console/command.h"
#include "rig/rig_file.h"
#include "rig/whole_file.h"
#include "sim/protocol/served_rig.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

struct SimulateOptions {
  std::string rig, scan_out;
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  double for_s = 0.0;
};

// "mute=0.01"
std::pair<Fault, double> parse_fault(const std::string& text) {
  const std::size_t equals = text.find('=');
  double probability = -1.0;
  std::istringstream number(equals == std::string::npos ? "" : text.substr(equals + 1));
  number >> probability;
  if (!number || !number.eof() || !(probability >= 0.0 && probability <= 1.0)) {
    throw BadInput("--fault", "'" + text + "'", "NAME=PROBABILITY with a probability from 0 to 1");
  }
  return {fault_from_string(text.substr(0, equals)), probability};
}

std::shared_ptr<FaultSource> fault_source(const SimulateOptions& options) {
  std::map<Fault, double> probabilities;
  double sum = 0.0;
  for (const std::string& text : options.faults) {
    const auto [fault, probability] = parse_fault(text);
    if (fault == Fault::None || probabilities.contains(fault)) throw BadInput("--fault", "'" + text + "'", "a fault, once");
    probabilities[fault] = probability;
    sum += probability;
  }
  if (sum > 1.0) throw BadInput("--fault", "probabilities that sum up to more than 1", "at most 1 in all");
  return std::make_shared<RandomFaults>(probabilities, options.seed);
}

void serve_until_stopped(const SimulateOptions& options, std::stop_token stop) {
  SystemClock clock;
  constexpr double kForever_s = 1e9;
  try {
    clock.sleep_until(clock.now_s() + (options.for_s > 0.0 ? options.for_s : kForever_s), std::move(stop));
  } catch (const Cancelled&) {
    // Ctrl-C is how this ends.
  }
}

CommandResult run(const SimulateOptions& options, CommandContext& context) {
  const std::shared_ptr<FaultSource> faults = fault_source(options);
  const RigDescription rig = parse_rig(read_rig_file(options.rig), options.rig);
  const HardwareDescription hardware = parse_hardware(rig.hardware_toml, options.rig);
  const std::shared_ptr<SimulatedWorld> world = build_world(rig, options.rig);
  if (!options.scan_out.empty()) write_whole_file(options.scan_out, encode_ply(scanned_mesh(*world)));
  const auto bench = make_rendered_bench(rig, world, std::make_shared<SystemClock>());
  const ServedRig served(hardware, bench, faults);
  for (const std::string& place : served.places()) std::cerr << "simulate: " << place << '\n';
  std::cerr << "simulate: ready; Ctrl-C ends\n" << std::flush;
  serve_until_stopped(options, context.stop);
  CommandResult result;
  result.json = {{"devices", served.places()}, {"exposures", bench->exposures()}, {"faults", nlohmann::json::array()}};
  std::ostringstream text;
  text << bench->exposures() << " exposures taken, " << faults->injected().size() << " faults injected\n";
  for (const InjectedFault& fault : faults->injected()) {
    result.json["faults"].push_back({{"fault", to_string(fault.fault)},
                                     {"device", fault.device},
                                     {"operation", fault.operation},
                                     {"count", fault.count}});
  }
  result.text = text.str();
  return result;
}

}  // namespace

void add_simulate_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<SimulateOptions>();
  Command command(app, "simulate", "Serve a rig's devices, simulated, over their real protocols, for any client; until Ctrl-C");
  command.add_option("RIG", options->rig, "Rig description with [hardware] and [simulation], TOML").required();
  command.add_option("--scan-out", options->scan_out, "Write the coarse mesh of the simulated object here (PLY)");
  command.add_option("--fault", options->faults,
                     "NAME=PROBABILITY: let every operation go wrong so often. mute, late_reply, exception, garbage, "
                     "half_reply, disconnect, lose_packets, reorder_packets, late_settings, false_metadata, stale_frame, "
                     "wedge, card_full, stuck_axis, lamp_fails; may be given several times");
  command.add_option("--seed", options->seed, "Of the faults").capture_default_str();
  command.add_option("--for", options->for_s, "Stop after so many seconds").positive();
  command.footer("\"simulate: ready\" on stderr says that clients may connect. `lumitexel capture RIG PLAN` is one.");
  command.callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
