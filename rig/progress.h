// Where long work says how far it is. The library reports; the console (or nobody) shows.
#pragma once

#include <cstdint>
#include <string>

namespace lumitexel {

class Progress {
 public:
  virtual ~Progress() = default;
  // A new stage of `total` steps, each called `unit` ("shots", "views"). Ends the stage before it.
  virtual void begin(const std::string& stage, std::int64_t total, const std::string& unit) = 0;
  // `done` steps of the current stage are finished. May be called from any thread.
  virtual void update(std::int64_t done) = 0;
  // What the current stage is at, where it is made of unlike parts. Until the next, or the next stage.
  virtual void part(const std::string&) {}
};

// Shows nothing.
class NoProgress final : public Progress {
 public:
  void begin(const std::string&, std::int64_t, const std::string&) override {}
  void update(std::int64_t) override {}
};

}  // namespace lumitexel
