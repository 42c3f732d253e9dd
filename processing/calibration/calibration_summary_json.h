// The summary as JSON, as views.json keeps it and `calibrate --json` prints it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "processing/calibration/calibration_summary.h"

namespace lumitexel {

nlohmann::json summary_json(const CalibrationSummary& summary);
// Throws nlohmann::json::exception if a key is missing or of the wrong type.
CalibrationSummary summary_from_json(const nlohmann::json& json);

}  // namespace lumitexel
