#include <memory>
#include <sstream>

#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/verify_session.h"

namespace lumitexel {
namespace {

constexpr int kNotOk = 1;

CommandResult run(const std::string& directory, CommandContext& context) {
  const SessionStore session = session_given("SESSION", directory);
  const SessionVerdict verdict = verify_session(session, context.progress);
  CommandResult result;
  result.exit_code = verdict.ok() ? 0 : kNotOk;
  nlohmann::json problems = nlohmann::json::array();
  std::ostringstream text;
  for (const SessionProblem& problem : verdict.problems) {
    problems.push_back({{"file", problem.file}, {"what", problem.what}});
    text << problem.file << ": " << problem.what << "\n";
  }
  result.json = {{"frames", verdict.frames}, {"ok", verdict.ok()}, {"problems", problems}};
  text << directory << ": " << verdict.frames << " frames, "
       << (verdict.ok() ? "all as recorded" : std::to_string(verdict.problems.size()) + " problems") << "\n";
  result.text = text.str();
  return result;
}

}  // namespace

void add_verify_command(CLI::App& app, CommandAction& action) {
  const auto directory = std::make_shared<std::string>();
  Command command(app, "verify", "Check every byte against its hash, every frame against its shot");
  command.add_option("SESSION", *directory, "The session's folder").required();
  command.callback(
      [directory, &action] { action = [directory](CommandContext& context) { return run(*directory, context); }; });
}

}  // namespace lumitexel
