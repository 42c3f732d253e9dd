// Progress on stderr: a bar with rate and time left on a terminal, now and then a line elsewhere.
#pragma once

#include <chrono>
#include <mutex>

#include "rig/progress.h"

namespace lumitexel {

class ConsoleProgress final : public Progress {
 public:
  ConsoleProgress();
  void begin(const std::string& stage, std::int64_t total, const std::string& unit) override;
  void update(std::int64_t done) override;
  void part(const std::string& name) override;
  void finish();  // ends the current stage's line

 private:
  using Instant = std::chrono::steady_clock::time_point;
  void show(std::int64_t done, Instant now);
  void finish_locked();

  std::mutex mutex_;
  bool terminal_ = false, open_ = false;
  std::string stage_, part_, unit_;
  std::int64_t total_ = 0, last_done_ = 0;
  Instant started_, shown_;
};

}  // namespace lumitexel
