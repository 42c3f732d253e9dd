#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>

#include "processing/calibration/calibrated_session.h"
#include "processing/fit/tradeoff.h"
#include "processing/fit/tradeoff_journal.h"
#include "processing/report/tradeoff_page.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/materials_option.h"
#include "rig/console/output_file.h"
#include "rig/sha256.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct TradeoffArguments {
  std::string session, page, keep, materials;
  bool full = false;
  int draws = 1;
  std::vector<std::string> only;
};

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string error_cell(const ErrorWithSpread& error) {
  const std::string sigma = std::isfinite(error.sigma) ? formatted("+- %.4f", error.sigma) : formatted("%9s", "");
  const std::string draws = std::isfinite(error.draw_deviation) ? formatted("%.4f", error.draw_deviation) : formatted("%6s", "-");
  return formatted("%7.4f %s %s", error.value, sigma.c_str(), draws.c_str());
}

std::string memory_cell(const std::optional<std::int64_t>& bytes) {
  return bytes ? formatted("%7.0f", static_cast<double>(*bytes) / 1e6) : formatted("%7s", "-");
}

std::string gain_cells(const std::optional<TradeoffGain>& gain) {
  if (!gain) return "";
  const std::string each = std::isfinite(gain->per_second) ? formatted("%+10.2e", gain->per_second) : formatted("%10s", "-");
  const std::string sigma = std::isfinite(gain->gain.sigma) ? formatted("+- %.4f", gain->gain.sigma) : "         ";
  return formatted("  %+8.4f %s %s", gain->gain.value, sigma.c_str(), each.c_str());
}

std::string measurement_line(const Tradeoff& tradeoff, const TradeoffMeasurement& m, bool front) {
  const std::string name = formatted("%c %-19s", front ? '*' : ' ', m.setting.name.c_str());
  if (!m.measured()) return name + "not measured: " + m.failure + "\n";
  const auto gain = m.setting.name == kStandardSetting ? std::nullopt : gain_over_standard(tradeoff, m);
  return name + formatted("%5zu %5s  %s  %7.4f %7.4f  %8.1f %7.1f %s", m.runs.front().fit_views, materials_text(m).c_str(), error_cell(m.clipped).c_str(), m.relative.value,
                          m.square_root.value, m.cpu_seconds, m.seconds, memory_cell(m.peak_bytes).c_str()) +
         gain_cells(gain) + "\n";
}

std::string tradeoff_text(const Tradeoff& tradeoff) {
  std::string text = formatted("Errors on %zu photograph%s that no fit saw; %zu more for fitting; each setting fitted %d time%s\n", tradeoff.heldout_views,
                               tradeoff.heldout_views == 1 ? "" : "s", tradeoff.fit_views, tradeoff.draws, tradeoff.draws == 1 ? "" : "s");
  if (tradeoff.known_before > 0) text += formatted("%zu of the fits were known from an earlier run\n", tradeoff.known_before);
  if (tradeoff.heldout_views == 1) text += "One photograph cannot tell how sure these errors are: no +-, and any order of settings may be chance\n";
  text += "                                  clipped error     one                        CPU                   gain over             gain\n"
          "  setting            views  mat.                    draw   relative    sqrt   seconds seconds peak MB  standard         per CPU s\n";
  const std::vector<bool> front = pareto_front(tradeoff.measurements);
  for (std::size_t i = 0; i < front.size(); ++i) text += measurement_line(tradeoff, tradeoff.measurements[i], front[i]);
  return text +
         "+-: standard error, over the photographs kept out and over draws of the surface points that materials are learnt on. One draw: how far\n"
         "a single fit's figure strays, 1 sigma" + std::string(tradeoff.draws > 1 ? ".\n" : "; not known from one draw: small differences may be chance, and --draws 4 tells.\n") +
         "* on the Pareto front: no setting is both faster and better by the clipped error. Gain: clipped error of standard less\n"
         "this one's, +- over the same views and draws. Per CPU second: of a slower setting what a second more buys, of a faster one what a\n"
         "second saved costs; below 0 one of the two is faster and better; - where times are within 5 %.\n"
         "CPU seconds: of all threads. Seconds: wall time, which other programs on this machine make longer.\n";
}

std::string session_name(const fs::path& session) {
  const fs::path whole = fs::absolute(session).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

// What each setting is, a line each.
std::string meanings(const std::vector<TradeoffSetting>& settings) {
  std::string text = "Settings: the presets, and the standard preset with this changed\n";
  for (const TradeoffSetting& setting : settings) text += formatted("  %-20s %s\n", setting.name.c_str(), setting.what.c_str());
  return text;
}

std::string tradeoff_legend(const Tradeoff& tradeoff) {
  std::vector<TradeoffSetting> settings;
  for (const TradeoffMeasurement& m : tradeoff.measurements) settings.push_back(m.setting);
  const bool standard = std::any_of(settings.begin(), settings.end(), [](const auto& setting) { return setting.name == kStandardSetting; });
  return meanings(settings) + (standard ? "" : "No gains: the setting standard, which they are measured against, was not asked for.\n");
}

std::string setting_names() {
  std::string names;
  for (const TradeoffSetting& setting : tradeoff_settings({}, true, {})) names += (names.empty() ? "" : ", ") + setting.name;
  return names;
}

// Whose measurements may stand beside each other: another program fits otherwise, another machine takes other times.
std::string program_and_machine() {
  std::ifstream processors("/proc/cpuinfo");
  std::string line, model = "unknown processor";
  while (std::getline(processors, line) && !line.starts_with("model name")) {}
  if (line.starts_with("model name")) model = line.substr(line.find(':') + 1);
  return "program " + sha256_hex(read_whole_file("/proc/self/exe")) + " on " + std::to_string(std::thread::hardware_concurrency()) + " x" + model;
}

CommandResult tradeoff_command(const TradeoffArguments& arguments, CommandContext& context) {
  std::optional<int> materials;
  if (!arguments.materials.empty()) materials = materials_wanted("--materials", arguments.materials);
  require_writable_folder("--page", arguments.page);
  const auto settings = tradeoff_settings(materials, arguments.full, arguments.only);
  const SessionStore store = session_given("SESSION", arguments.session);
  const CalibratedSession session = calibrate_session(store, context.progress);
  std::optional<TradeoffJournal> journal;
  if (!arguments.keep.empty()) journal.emplace(arguments.keep, session.key + " by " + program_and_machine());
  const Tradeoff tradeoff = measure_tradeoff(session, settings, arguments.draws, journal ? &*journal : nullptr, context.progress);
  const std::string json = tradeoff_json(tradeoff);
  CommandResult result;
  result.json = nlohmann::json::parse(json);
  result.text = tradeoff_text(tradeoff) + tradeoff_legend(tradeoff);
  if (!arguments.page.empty()) {
    write_whole_file(arguments.page, tradeoff_page(session_name(arguments.session), tradeoff, json));
    result.text += arguments.page + ": the same as a page with the front drawn\n";
  }
  return result;
}

}  // namespace

void add_tradeoff_command(CLI::App& app, CommandAction& action) {
  auto arguments = std::make_shared<TradeoffArguments>();
  Command command(app, "tradeoff", "Speed against accuracy on this session: fits it with one setting after another, each judged by held-out photographs");
  command.add_option("SESSION", arguments->session, "Session to fit, with held-out views").required();
  command.add_option("--materials", arguments->materials, "Materials of every fit, 1 to 64, or auto (default: auto, but for settings that say how many, and the paper's method, which "
                     "does not choose: 4)");
  command.add_flag("--reference,--full", arguments->full, "Also the reference preset, the most thorough");
  command.add_option("--only", arguments->only, "These settings only: " + setting_names()).delimiter(',').type_name("NAME");
  command.footer(meanings(tradeoff_settings({}, true, {})));
  command.add_option("--draws", arguments->draws, "Fits of each setting, each to materials learnt on other surface points: tells what of a difference is chance")
      .range(1, 100)
      .capture_default_str();
  command.add_option("--keep", arguments->keep, "File of fits, added to as they come; those it has of this session, setting, draw, program and machine are not made again");
  command.add_option("--page", arguments->page, "HTML file to write, with a drawing of error against CPU seconds");
  command.callback([arguments, &action] {
    action = [arguments](CommandContext& context) { return tradeoff_command(*arguments, context); };
  });
}

}  // namespace lumitexel
