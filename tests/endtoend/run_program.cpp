#include "tests/endtoend/run_program.h"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
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

}  // namespace lumitexel
