// Where the faults of simulated devices come from. A protocol server asks at every operation that it is about to carry
// out whether that one shall go wrong, and how; it does nothing wrong of its own accord.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace lumitexel {

enum class Fault {
  None,
  // on a connection
  Mute,         // the request is not answered
  LateReply,    // answered after the client has given up waiting
  Exception,    // answered with the protocol's error code
  Garbage,      // answered with random bytes
  HalfReply,    // the reply breaks off in its middle
  Disconnect,   // the connection is closed, or control is lost
  // of a camera
  LosePackets,     // some of the frame's packets do not arrive at first
  ReorderPackets,  // they arrive in another order
  LateSettings,    // the frame is taken with earlier settings, and says so
  FalseMetadata,   // the frame reports settings that it was not taken with
  StaleFrame,      // the frame before is delivered once more
  Wedge,           // takes commands and delivers nothing, until it is reconnected
  CardFull,
  // of the bench
  StuckAxis,  // the motion that starts now does not end
  LampFails,  // the lamp that is switched on now stays dark
};

const char* to_string(Fault fault);                // "none", "lose_packets", …
Fault fault_from_string(const std::string& name);  // throws BadInput on any other name

struct InjectedFault {
  Fault fault = Fault::None;
  std::string device, operation;
  std::uint64_t count = 0;  // of the device's operations when it happened, from 1
};

// Thread-safe. Keeps count of the operations and a log of what it let go wrong.
class FaultSource {
 public:
  virtual ~FaultSource() = default;

  // device: "camera", "controller", …; operation: what the server is about to do, such as "write_register", "frame",
  // "capture"; possible: the faults that make sense there. Returns one of them or None.
  Fault next(const std::string& device, const std::string& operation, const std::vector<Fault>& possible);

  // A number in [0, 1) for how a fault looks in detail (which packets, which bytes): the same for the same seed and count.
  double detail();

  std::vector<InjectedFault> injected() const;
  std::uint64_t operations(const std::string& device) const;

 protected:
  explicit FaultSource(std::uint64_t seed) : seed_(seed) {}
  // count: of this device's operations, from 1. Called under the lock.
  virtual Fault choose(const std::string& device, const std::string& operation, std::uint64_t count,
                       const std::vector<Fault>& possible) = 0;
  std::uint64_t seed() const { return seed_; }

 private:
  std::uint64_t seed_, details_ = 0;
  mutable std::mutex mutex_;
  std::map<std::string, std::uint64_t> counts_;
  std::vector<InjectedFault> injected_;
};

class NoFaults final : public FaultSource {
 public:
  NoFaults() : FaultSource(0) {}

 private:
  Fault choose(const std::string&, const std::string&, std::uint64_t, const std::vector<Fault>&) override {
    return Fault::None;
  }
};

// One fault, at the device's operation number `at` or the first one after it where it is possible.
class OneFault final : public FaultSource {
 public:
  OneFault(std::string device, Fault fault, std::uint64_t at, std::uint64_t seed = 1)
      : FaultSource(seed), device_(std::move(device)), fault_(fault), at_(at) {}

 private:
  Fault choose(const std::string& device, const std::string& operation, std::uint64_t count,
               const std::vector<Fault>& possible) override;

  std::string device_;
  Fault fault_;
  std::uint64_t at_;
  bool done_ = false;
};

// Each fault with its own probability at every operation where it is possible.
class RandomFaults final : public FaultSource {
 public:
  RandomFaults(std::map<Fault, double> probabilities, std::uint64_t seed)
      : FaultSource(seed), probabilities_(std::move(probabilities)) {}

 private:
  Fault choose(const std::string& device, const std::string& operation, std::uint64_t count,
               const std::vector<Fault>& possible) override;

  std::map<Fault, double> probabilities_;
};

}  // namespace lumitexel
