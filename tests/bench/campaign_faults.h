// Random faults whose probabilities differ from device to device: a controller is asked for much more than a camera.
#pragma once

#include <map>
#include <string>

#include "sim/fault_source.h"

namespace lumitexel {

using FaultRates = std::map<std::string, std::map<Fault, double>>;  // by device, per operation

class FaultsByDevice final : public FaultSource {
 public:
  FaultsByDevice(FaultRates rates, std::uint64_t seed);

 private:
  Fault choose(const std::string& device, const std::string& operation, std::uint64_t count,
               const std::vector<Fault>& possible) override;
  FaultRates rates_;
};

// Such that a campaign of 10,000 shots suffers each kind at least 50 times. scale: of all of them.
FaultRates gige_rig_rates(double scale);
FaultRates still_rig_rates(double scale);

}  // namespace lumitexel
