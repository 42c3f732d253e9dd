// Faults when the test says so: one, so many operations from now, or the same at every operation.
#pragma once

#include <algorithm>
#include <mutex>

#include "sim/fault_source.h"

namespace lumitexel {

class ArmedFaults final : public FaultSource {
 public:
  ArmedFaults() : FaultSource(7) {}

  // After `skipped` operations where it would have been possible, once.
  void arm_one(Fault fault, int skipped) { arm(fault, skipped, false); }
  void arm_all(Fault fault) { arm(fault, 0, true); }
  void disarm() { arm(Fault::None, 0, false); }

 private:
  void arm(Fault fault, int skipped, bool all) {
    const std::lock_guard lock(arming_);
    fault_ = fault;
    skip_ = skipped;
    all_ = all;
  }
  Fault choose(const std::string&, const std::string&, std::uint64_t, const std::vector<Fault>& possible) override {
    const std::lock_guard lock(arming_);
    if (fault_ == Fault::None || std::find(possible.begin(), possible.end(), fault_) == possible.end())
      return Fault::None;
    if (skip_-- > 0) return Fault::None;
    const Fault fault = fault_;
    if (!all_) fault_ = Fault::None;
    return fault;
  }

  std::mutex arming_;
  Fault fault_ = Fault::None;
  int skip_ = 0;
  bool all_ = false;
};

}  // namespace lumitexel
