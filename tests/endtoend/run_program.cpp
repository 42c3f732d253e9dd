#include "tests/endtoend/run_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

constexpr std::chrono::seconds kPatience(120);  // a bound on a run that hangs, not a measure

// Whether it became true before patience ended.
bool await(const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!done()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

// The shell makes way for the program, so that the signal meets that.
pid_t started(const std::string& command) {
  const pid_t child = fork();
  if (child != 0) return child;
  std::signal(SIGINT, SIG_DFL);  // which tests in the background ignore
  execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
  std::_Exit(127);
}

}  // namespace

ProgramRun run_program(const std::string& arguments, const std::string& before) {
  const TemporaryFolder folder;
  const std::string command = before + LUMITEXEL_PROGRAM + " " + arguments + " >" + (folder / "out").string() +
                              " 2>" + (folder / "err").string();
  ProgramRun run;
  const int status = std::system(command.c_str());
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  run.output = contents(folder / "out");
  run.errors = contents(folder / "err");
  return run;
}

ProgramRun run_program_until(const std::string& arguments, const std::string& word, int signal) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder / "out", err = folder / "err";
  const pid_t child = started(LUMITEXEL_PROGRAM " " + arguments + " >" + out.string() + " 2>" + err.string());
  int status = 0;
  bool ended = false;
  const auto has_ended = [&] { return ended = ended || waitpid(child, &status, WNOHANG) == child; };
  await([&] { return has_ended() || contents(err).find(word) != std::string::npos; });
  if (!ended) kill(child, signal);
  if (!await(has_ended)) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
}

}  // namespace lumitexel
