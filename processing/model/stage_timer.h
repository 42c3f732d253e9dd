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
  std::int64_t peak_bytes = 0;  // largest resident size of the process so far, when the stage ended
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

}  // namespace lumitexel
