#include "sim/fault_source.h"

#include <algorithm>
#include <array>
#include <utility>

#include "drivers/error.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr std::array<std::pair<Fault, const char*>, 16> kNames{{{Fault::None, "none"},
                                                                {Fault::Mute, "mute"},
                                                                {Fault::LateReply, "late_reply"},
                                                                {Fault::Exception, "exception"},
                                                                {Fault::Garbage, "garbage"},
                                                                {Fault::HalfReply, "half_reply"},
                                                                {Fault::Disconnect, "disconnect"},
                                                                {Fault::LosePackets, "lose_packets"},
                                                                {Fault::ReorderPackets, "reorder_packets"},
                                                                {Fault::LateSettings, "late_settings"},
                                                                {Fault::FalseMetadata, "false_metadata"},
                                                                {Fault::StaleFrame, "stale_frame"},
                                                                {Fault::Wedge, "wedge"},
                                                                {Fault::CardFull, "card_full"},
                                                                {Fault::StuckAxis, "stuck_axis"},
                                                                {Fault::LampFails, "lamp_fails"}}};

std::uint64_t key_of(const std::string& text) {
  std::uint64_t key = 0;
  for (const char c : text) key = scrambled(key ^ static_cast<unsigned char>(c));
  return key;
}

}  // namespace

const char* to_string(Fault fault) {
  for (const auto& [value, name] : kNames) {
    if (value == fault) return name;
  }
  return "unknown";
}

Fault fault_from_string(const std::string& name) {
  std::string all;
  for (const auto& [value, known] : kNames) {
    if (name == known) return value;
    all += (all.empty() ? "" : ", ") + std::string(known);
  }
  throw BadInput("fault", "'" + name + "'", all);
}

Fault FaultSource::next(const std::string& device, const std::string& operation, const std::vector<Fault>& possible) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t count = ++counts_[device];
  const Fault fault = choose(device, operation, count, possible);
  if (fault != Fault::None) injected_.push_back({fault, device, operation, count});
  return fault;
}

double FaultSource::detail() {
  const std::lock_guard lock(mutex_);
  return CounterRandom(extended_key(seed_, std::uint64_t{0xde7a11}), details_++).uniform();
}

std::vector<InjectedFault> FaultSource::injected() const {
  const std::lock_guard lock(mutex_);
  return injected_;
}

std::uint64_t FaultSource::operations(const std::string& device) const {
  const std::lock_guard lock(mutex_);
  const auto found = counts_.find(device);
  return found == counts_.end() ? 0 : found->second;
}

Fault OneFault::choose(const std::string& device, const std::string&, std::uint64_t count,
                       const std::vector<Fault>& possible) {
  if (done_ || device != device_ || count < at_) return Fault::None;
  if (std::find(possible.begin(), possible.end(), fault_) == possible.end()) return Fault::None;
  done_ = true;
  return fault_;
}

// One number is drawn; the possible faults' probabilities divide the line from 0 on.
Fault RandomFaults::choose(const std::string& device, const std::string&, std::uint64_t count,
                           const std::vector<Fault>& possible) {
  double drawn = CounterRandom(extended_key(seed(), key_of(device)), count).uniform();
  for (const Fault fault : possible) {
    const auto found = probabilities_.find(fault);
    if (found == probabilities_.end()) continue;
    if (drawn < found->second) return fault;
    drawn -= found->second;
  }
  return Fault::None;
}

}  // namespace lumitexel
