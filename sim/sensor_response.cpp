#include "sim/sensor_response.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kExponent = 0.45, kToe = 0.02;
constexpr double kKnee = 0.5, kWidth = 0.2;

double gamma_curve(double x) { return std::pow(std::max(x + kToe, 0.0), kExponent); }
double shoulder(double x) { return x < kKnee ? x : kKnee + kWidth * std::log1p((x - kKnee) / kWidth); }

}  // namespace

std::optional<SensorResponse> sensor_response_named(const std::string& name) {
  for (const SensorResponse response : {SensorResponse::Linear, SensorResponse::Gamma, SensorResponse::LogShoulder}) {
    if (name == to_string(response)) return response;
  }
  return std::nullopt;
}

const char* to_string(SensorResponse response) {
  switch (response) {
    case SensorResponse::Gamma: return "gamma";
    case SensorResponse::LogShoulder: return "log-shoulder";
    case SensorResponse::Linear: break;
  }
  return "linear";
}

double response_at(SensorResponse response, double x) {
  switch (response) {
    case SensorResponse::Gamma:
      return (gamma_curve(x) - gamma_curve(0.0)) / (gamma_curve(1.0) - gamma_curve(0.0));
    case SensorResponse::LogShoulder: return shoulder(x) / shoulder(1.0);
    case SensorResponse::Linear: break;
  }
  return x;
}

}  // namespace lumitexel
