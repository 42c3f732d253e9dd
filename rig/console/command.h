// What a subcommand is: its options (command_line.h), and one function to run. Each command lives in
// command_<name>.cpp: it reads its options, calls one library function and says what came out.
//
// Result and logs: with --json the JSON goes to stdout and nothing else does; without it the text does. Progress and
// logs go to stderr. Exit codes: 0 done, 1 the work failed, 2 bad usage or input.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>

#include "rig/console/command_line.h"
#include "rig/progress.h"

namespace lumitexel {

struct CommandResult {
  nlohmann::json json;
  std::string text;
  int exit_code = 0;
};

struct CommandContext {
  Progress& progress;
  std::stop_token stop;  // set by Ctrl-C
};

using CommandAction = std::function<CommandResult(CommandContext&)>;

// Each declares its subcommand on `app` and, when the user chose it, sets `action`.
void add_commission_command(CLI::App& app, CommandAction& action);
void add_plan_command(CLI::App& app, CommandAction& action);
void add_simulate_command(CLI::App& app, CommandAction& action);
void add_capture_command(CLI::App& app, CommandAction& action);
void add_resume_command(CLI::App& app, CommandAction& action);
void add_verify_command(CLI::App& app, CommandAction& action);
void add_replay_command(CLI::App& app, CommandAction& action);
void add_import_command(CLI::App& app, CommandAction& action);
void add_calibrate_command(CLI::App& app, CommandAction& action);
void add_fit_command(CLI::App& app, CommandAction& action);
void add_experiment_command(CLI::App& app, CommandAction& action);
void add_render_command(CLI::App& app, CommandAction& action);
void add_mip_command(CLI::App& app, CommandAction& action);
void add_evaluate_command(CLI::App& app, CommandAction& action);
void add_tradeoff_command(CLI::App& app, CommandAction& action);
void add_export_command(CLI::App& app, CommandAction& action);
void add_report_command(CLI::App& app, CommandAction& action);
void add_view_command(CLI::App& app, CommandAction& action);
void add_selftest_command(CLI::App& app, CommandAction& action);

}  // namespace lumitexel
