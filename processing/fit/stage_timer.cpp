#include "processing/fit/stage_timer.h"

#include <malloc.h>
#include <sys/resource.h>

#include <fstream>

namespace lumitexel {

void StageTimer::begin(const std::string& name) {
  end();
  stages_.push_back({name, 0.0, 0});
  started_ = std::chrono::steady_clock::now();
  open_ = true;
}

void StageTimer::end() {
  if (!open_) return;
  stages_.back().seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  stages_.back().peak_bytes = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
  open_ = false;
}

bool restart_peak_memory() {
  malloc_trim(0);
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;  // proc(5): resets the peak resident size, which getrusage reports too
  return static_cast<bool>(file);
}

}  // namespace lumitexel
