// Settings and measurements of a tradeoff as JSON, and back.
#pragma once

#include <nlohmann/json.hpp>

#include "processing/fit/tradeoff.h"

namespace lumitexel {

// Everything that a fit of this setting depends on besides the session and the program.
nlohmann::ordered_json setting_json(const TradeoffSetting& setting);

nlohmann::ordered_json measurement_json(const TradeoffMeasurement& measurement);  // figures that do not exist are null
void measurement_from(const nlohmann::ordered_json& json, TradeoffMeasurement& measurement);  // all but setting and failure; throws nlohmann's errors

}  // namespace lumitexel
