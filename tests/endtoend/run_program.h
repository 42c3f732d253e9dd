// Runs the lumitexel program as a user does and reads what it says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lumitexel {

struct ProgramRun {
  int exit_code = -1;
  std::string output;  // stdout
  std::string errors;  // stderr
  nlohmann::json json() const { return nlohmann::json::parse(output); }
};

// arguments: as typed in a shell, after the program's name; before: what stands before it, "timeout 5 " for instance.
ProgramRun run_program(const std::string& arguments, const std::string& before = "");

// The same, sent the signal once its stderr holds `word`: exit_code is -1 if that ended it. Killed if it says nothing of the kind or does not end.
ProgramRun run_program_until(const std::string& arguments, const std::string& word, int signal);

}  // namespace lumitexel
