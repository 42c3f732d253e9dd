// Wall time and peak memory of each stage of a fit.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace lumitexel {

struct StageCost {
  std::string name;
  double seconds = 0;
  std::int64_t peak_bytes = 0;  // largest resident size of the process so far, or since restart_peak_memory()
};

class StageTimer {
 public:
  void begin(const std::string& name);  // ends the stage before it
  void end();
  const std::vector<StageCost>& stages() const { return stages_; }

 private:
  bool open_ = false;
  std::chrono::steady_clock::time_point started_;
  std::vector<StageCost> stages_;
};

// Lets StageCost::peak_bytes count from here on instead of from the process's start, and gives free memory back first.
// False where the system does not allow it; then nothing has changed.
bool restart_peak_memory();

}  // namespace lumitexel
