// Settings and measurements of a tradeoff as JSON, and back.
#pragma once

#include <nlohmann/json.hpp>

#include "processing/fit/tradeoff.h"

namespace lumitexel {

// What a setting of this program changes about a fit; what none of them changes (layout, how normals and light between surfaces are
// sought) only another program would change.
nlohmann::ordered_json setting_json(const TradeoffSetting& setting);

nlohmann::ordered_json run_json(const TradeoffRun& run);  // of a run that was measured; figures that do not exist are null
TradeoffRun run_from(const nlohmann::ordered_json& json);  // throws nlohmann's errors

}  // namespace lumitexel
