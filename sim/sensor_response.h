// How a sensor's code grows with its electrons. Codes from black to full scale are the same for all: only the way between
// differs.
#pragma once

#include <optional>
#include <string>

namespace lumitexel {

enum class SensorResponse {
  Linear,
  Gamma,        // ((x + t)^0.45 - t^0.45) / ((1 + t)^0.45 - t^0.45), t = 0.02: a video camera's, of finite slope at black
  LogShoulder,  // linear up to half of full scale in electrons, logarithmic above
};

std::optional<SensorResponse> sensor_response_named(const std::string& name);  // "linear", "gamma", "log-shoulder"
const char* to_string(SensorResponse response);

// Share of full scale for a share x of the full well; monotonic, 0 at 0, 1 at 1. x may be a little negative, from read noise.
double response_at(SensorResponse response, double x);

}  // namespace lumitexel
