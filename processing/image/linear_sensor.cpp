#include "processing/image/linear_sensor.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

double LinearSensor::variance_dn2(double signal_dn) const {
  constexpr double kRounding = 1.0 / 12.0;
  return std::max(signal_dn, 0.0) / electrons_per_dn + read_noise_dn * read_noise_dn + kRounding;
}

double LinearSensor::usable_below_dn() const {
  return clip_dn - 4.0 * std::sqrt(variance_dn2(clip_dn - black_level_dn));
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
