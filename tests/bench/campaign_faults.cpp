#include "tests/bench/campaign_faults.h"

#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

std::map<Fault, double> of_connection(double each) {
  return {{Fault::Mute, each},    {Fault::LateReply, each}, {Fault::Exception, each},
          {Fault::Garbage, each}, {Fault::HalfReply, each}, {Fault::Disconnect, each}};
}

FaultRates scaled(FaultRates rates, double scale) {
  for (auto& [device, faults] : rates) {
    for (auto& [fault, rate] : faults) rate *= scale;
  }
  return rates;
}

std::map<Fault, double> of_controller() {
  std::map<Fault, double> faults = of_connection(2e-4);
  faults[Fault::StuckAxis] = 0.01;  // at starts of motions alone
  faults[Fault::LampFails] = 0.015;
  return faults;
}

}  // namespace

FaultsByDevice::FaultsByDevice(FaultRates rates, std::uint64_t seed) : FaultSource(seed), rates_(std::move(rates)) {}

// One number is drawn; the possible faults' probabilities divide the line from 0 on.
Fault FaultsByDevice::choose(const std::string& device, const std::string&, std::uint64_t count,
                             const std::vector<Fault>& possible) {
  const auto rates = rates_.find(device);
  if (rates == rates_.end()) return Fault::None;
  double drawn = CounterRandom(extended_key(seed(), std::uint64_t{device.size()}), count).uniform();
  for (const Fault fault : possible) {
    const auto rate = rates->second.find(fault);
    if (rate == rates->second.end()) continue;
    if (drawn < rate->second) return fault;
    drawn -= rate->second;
  }
  return Fault::None;
}

FaultRates gige_rig_rates(double scale) {
  std::map<Fault, double> camera = of_connection(4e-4);
  camera[Fault::LosePackets] = 0.02;
  camera[Fault::ReorderPackets] = 0.02;
  camera[Fault::LateSettings] = 0.02;
  camera[Fault::FalseMetadata] = 0.02;
  camera[Fault::StaleFrame] = 0.02;
  camera[Fault::Wedge] = 0.004;
  return scaled({{"camera", camera}, {"controller", of_controller()}}, scale);
}

FaultRates still_rig_rates(double scale) {
  std::map<Fault, double> camera = of_connection(1.5e-3);
  camera[Fault::LateSettings] = 0.03;
  camera[Fault::FalseMetadata] = 0.03;
  camera[Fault::StaleFrame] = 0.03;
  camera[Fault::Wedge] = 0.01;
  camera[Fault::CardFull] = 0.15;
  return scaled({{"camera", camera}, {"controller", of_controller()}}, scale);
}

}  // namespace lumitexel
