#include "processing/image/linear_sensor.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "drivers/error.h"

namespace lumitexel {

double LinearSensor::variance_dn2(double signal_dn) const {
  constexpr double kRounding = 1.0 / 12.0;
  return std::max(signal_dn, 0.0) / electrons_per_dn + read_noise_dn * read_noise_dn + kRounding;
}

double LinearSensor::usable_below_dn() const {
  // One saturated sample taken for a good one, in a long exposure, ruins its pixel: of 5e7 samples of a bracket at 12
  // Mpixel, 0.002 lie below. At four standard deviations it would be 1500.
  constexpr double kClearSigmas = 6.5;
  return clip_dn - kClearSigmas * std::sqrt(variance_dn2(0.0) + clip_spread_dn * clip_spread_dn);
}

void check_sensor(const LinearSensor& sensor) {
  const auto require = [](bool good, const char* field, double value, const char* expected) {
    if (!good) throw BadInput(std::string("sensor: ") + field, std::to_string(value), expected);
  };
  require(std::isfinite(sensor.electrons_per_dn) && sensor.electrons_per_dn > 0.0, "electrons_per_dn",
          sensor.electrons_per_dn, "a positive number");
  require(std::isfinite(sensor.read_noise_dn) && sensor.read_noise_dn >= 0.0, "read_noise_dn", sensor.read_noise_dn,
          "zero or more");
  require(std::isfinite(sensor.black_level_dn), "black_level_dn", sensor.black_level_dn, "a finite number");
  require(std::isfinite(sensor.clip_spread_dn) && sensor.clip_spread_dn >= 0.0, "clip_spread_dn", sensor.clip_spread_dn,
          "zero or more");
  require(std::isfinite(sensor.clip_dn) && sensor.usable_below_dn() > sensor.black_level_dn, "clip_dn", sensor.clip_dn,
          "more than the black level and 6.5 standard deviations of read noise");
}

LinearSensor linear_sensor(const CameraDescription& camera, double gain_db) {
  LinearSensor sensor;
  sensor.electrons_per_dn = camera.sensor.electrons_per_dn / std::pow(10.0, gain_db / 20.0);
  sensor.read_noise_dn = camera.sensor.read_noise_e / sensor.electrons_per_dn;
  sensor.black_level_dn = camera.sensor.black_level_dn;
  sensor.clip_dn = std::min(std::ldexp(1.0, camera.limits.bits) - 1.0,
                            sensor.black_level_dn + camera.sensor.full_well_e / sensor.electrons_per_dn);
  return sensor;
}

int mosaic_channel(Mosaic mosaic, int x, int y) {
  const int place = (y & 1) * 2 + (x & 1);  // (0,0) (1,0) / (0,1) (1,1)
  switch (mosaic) {
    case Mosaic::Mono:
      return 0;
    case Mosaic::Rggb:
      return place == 0 ? 0 : place == 3 ? 2 : 1;
    case Mosaic::Bggr:
      return place == 0 ? 2 : place == 3 ? 0 : 1;
    case Mosaic::Grbg:
      return place == 1 ? 0 : place == 2 ? 2 : 1;
    case Mosaic::Gbrg:
      return place == 2 ? 0 : place == 1 ? 2 : 1;
  }
  return 0;
}

}  // namespace lumitexel
