// Fits made up for tests: error by view, CPU seconds.
#pragma once

#include <numeric>

#include "processing/fit/tradeoff.h"

namespace lumitexel {

inline TradeoffRun made_run(double cpu_seconds, const std::vector<double>& errors) {
  TradeoffRun run;
  run.cpu_seconds = cpu_seconds;
  run.seconds = 1.0;  // wall time decides nothing
  run.clipped.by_view = errors;
  run.clipped.pooled = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  run.relative = run.square_root = run.clipped;
  return run;
}

inline TradeoffMeasurement made_measurement(const std::string& name, double cpu_seconds, const std::vector<double>& errors) {
  TradeoffSetting setting;
  setting.name = name;
  return summed_up(setting, {made_run(cpu_seconds, errors)});
}

}  // namespace lumitexel
