// Measurements made up for tests: error by view, CPU seconds.
#pragma once

#include "processing/fit/tradeoff.h"

namespace lumitexel {

inline TradeoffMeasurement made_measurement(const std::string& name, double cpu_seconds, const std::vector<double>& errors) {
  TradeoffMeasurement measurement;
  measurement.setting.name = name;
  measurement.cpu_seconds = cpu_seconds;
  measurement.seconds = 1.0;  // wall time decides nothing
  measurement.clipped_by_view = errors;
  measurement.clipped = mean_with_spread(errors);
  measurement.relative = measurement.square_root = measurement.clipped;
  return measurement;
}

}  // namespace lumitexel
