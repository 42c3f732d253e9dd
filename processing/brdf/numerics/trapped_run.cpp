#include "processing/brdf/numerics/trapped_run.h"

#include <fenv.h>
#include <oneapi/tbb/global_control.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace lumitexel {
namespace {

// Tells the parent which part begins, so that it can name the one that failed.
[[noreturn]] void run_in_child(const std::vector<TrappedPart>& parts, int report) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  int status = 0;
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  try {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto index = static_cast<std::uint8_t>(k);
      if (write(report, &index, 1) != 1) status = 1;
      parts[k].run();
    }
  } catch (...) {
    status = 1;
  }
  _exit(status);
}

}  // namespace

NumericCase run_trapped(const std::vector<TrappedPart>& parts) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    close(ends[0]);
    run_in_child(parts, ends[1]);
  }
  close(ends[1]);
  std::uint8_t last = 0;
  while (read(ends[0], &last, 1) == 1) {}
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return {"traps for invalid, divide by zero, overflow", ended ? "all of this once: traps raised" : "trap raised in: " + parts[last].name,
          ended ? 0.0 : 1.0, 0.0};
}

}  // namespace lumitexel
