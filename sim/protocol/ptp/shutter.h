// Takes the simulated camera's pictures, one at a time on a thread of its own, and puts them on its card.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "sim/fault_source.h"
#include "sim/protocol/ptp/memory_card.h"
#include "sim/simulated_bench.h"

namespace lumitexel::ptp {

struct Release {
  CameraSettings settings;
  int iso = 100;
  double f_number = 8.0;
  std::string artist;
  // LateSettings, FalseMetadata and StaleFrame show in the picture; others mean nothing here.
  Fault fault = Fault::None;
  std::uint64_t session = 0;  // whoever asked: it alone is told
  std::uint32_t transaction = 0;
};

struct ShutterIdentity {
  std::string make, model, serial;
};

class Shutter {
 public:
  // Called from the shutter's thread, once the picture is on the card.
  using Finished = std::function<void(const Release&, std::uint32_t handle, std::stop_token)>;

  Shutter(std::shared_ptr<SimulatedBench> bench, MemoryCard& card, ShutterIdentity identity, Finished finished);

  // False while a picture is being taken: nothing happens then.
  bool release(const Release& release);
  // Whether a picture was taken before that could be delivered again.
  bool has_picture() const;

 private:
  void run(std::stop_token stop);
  void take(const Release& release, std::stop_token stop);
  StoredPicture expose(const Release& release, std::stop_token stop);

  std::shared_ptr<SimulatedBench> bench_;
  MemoryCard& card_;
  ShutterIdentity identity_;
  Finished finished_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<Release> waiting_, earlier_;
  bool busy_ = false;
  SharedBytes last_file_;
  std::uint32_t pictures_ = 0;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace lumitexel::ptp
