#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>

#include "drivers/error.h"
#include "rig/console/command.h"
#include "rig/console/console_progress.h"
#include "rig/console/interrupt.h"

namespace lumitexel {
namespace {

constexpr int kFailed = 1, kBadInput = 2;

// In the order in which a user meets them; the help lists them so.
const std::vector<void (*)(CLI::App&, CommandAction&)> kCommands = {
    add_commission_command,
    add_plan_command,
    add_simulate_command,
    add_capture_command,
    add_resume_command,
    add_verify_command,
    add_replay_command,
    add_import_command,
    add_calibrate_command,
    add_fit_command,
    add_experiment_command,
    add_render_command,
    add_mip_command,
    add_evaluate_command,
    add_tradeoff_command,
    add_export_command,
    add_report_command,
    add_view_command,
    add_selftest_command,
};

// Those that end cleanly on Ctrl-C; the others may be killed at any time and are, with a word.
bool watches_for_stop(const CLI::App& app) {
  for (const char* name : {"commission", "simulate", "capture", "resume", "replay", "import"}) {
    if (app.got_subcommand(name)) return true;
  }
  return false;
}

std::stop_token stop_token_for(const CLI::App& app) {
  if (watches_for_stop(app)) return stop_on_interrupt();
  end_on_interrupt();
  return {};
}

int run(const CommandAction& action, bool json, std::stop_token stop) {
  ConsoleProgress progress;
  CommandContext context{progress, stop};
  try {
    const CommandResult result = action(context);
    progress.finish();
    if (json) {
      std::cout << result.json.dump(2) << '\n';
    } else {
      std::cout << result.text;
    }
    return result.exit_code;
  } catch (const BadInput& error) {
    progress.finish();
    std::cerr << "lumitexel: " << error.what() << '\n';
    return kBadInput;
  } catch (const Corrupt& error) {  // what was given is damaged
    progress.finish();
    std::cerr << "lumitexel: " << error.what() << '\n';
    return kBadInput;
  } catch (const Cancelled&) {
    progress.finish();
    std::cerr << "lumitexel: stopped as asked; lamps are off. A session keeps what it has, and `lumitexel resume` with its folder goes on\n";
    return kFailed;
  } catch (const std::exception& error) {
    progress.finish();
    std::cerr << "lumitexel: " << error.what() << '\n';
    return kFailed;
  }
}

// On every command too, so that each one's help shows it.
void add_json_flag(CLI::App& app, bool& json) {
  constexpr const char* kMeaning = "Print a machine-readable result on stdout (logs stay on stderr)";
  app.add_flag("--json", json, kMeaning);
  for (CLI::App* command : app.get_subcommands({})) command->add_flag("--json", json, kMeaning);
}

std::string command_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

// The first argument that is no option, if no command is called so. Before the command all options are flags.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  const auto is_option = [](const std::string& argument) { return argument.starts_with('-'); };
  const auto word = std::find_if_not(argv + 1, argv + argc, is_option);
  if (word == argv + argc) return "";
  const auto commands = app.get_subcommands({});
  const bool known = std::any_of(commands.begin(), commands.end(), [&](const CLI::App* command) { return command->get_name() == *word; });
  return known ? "" : *word;
}

int main_function(int argc, char** argv) {
  CLI::App app{"Photographs an object on a rig and measures how it reflects light."};
  app.name("lumitexel");
  app.require_subcommand(1);
  app.fallthrough();
  bool json = false;
  CommandAction action;
  for (const auto add : kCommands) add(app, action);
  add_json_flag(app, json);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app, argc, argv); !unknown.empty()) {
      std::cerr << "lumitexel: '" << unknown << "' is no command; expected one of " << command_names(app) << '\n';
      return kBadInput;
    }
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  return run(action, json, stop_token_for(app));
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) { return lumitexel::main_function(argc, argv); }
