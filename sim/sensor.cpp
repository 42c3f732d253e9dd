#include "sim/sensor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "processing/image/linear_sensor.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr std::uint64_t kHotPixelStream = 400;

}  // namespace

SimulatedSensor::SimulatedSensor(const CameraDescription& camera, const SimulationSettings& settings)
    : camera_(camera), settings_(settings) {}

bool SimulatedSensor::is_hot(int x, int y) const {
  const auto pixel = static_cast<std::uint64_t>(y * camera_.limits.width_px + x);
  return CounterRandom(extended_key(settings_.seed, kHotPixelStream), pixel).uniform() < settings_.hot_pixel_fraction;
}

double SimulatedSensor::dark_current_e_per_s(int x, int y, double warming_k) const {
  const double warmth =
      std::exp2((settings_.sensor_temperature_c + warming_k - 20.0) / settings_.dark_current_doubling_k);
  double at_20_c = settings_.dark_current_e_per_s;
  if (is_hot(x, y)) {
    const auto pixel = static_cast<std::uint64_t>(y * camera_.limits.width_px + x);
    CounterRandom random(extended_key(settings_.seed, kHotPixelStream + 1), pixel);
    at_20_c -= settings_.hot_pixel_current_e_per_s * std::log(random.uniform());
  }
  return at_20_c * warmth;
}

double SimulatedSensor::radiance_seen(const Image& radiance, int x, int y) const {
  const Mosaic mosaic = camera_.limits.mosaic;
  if (mosaic != Mosaic::Mono) return radiance.at(x, y, mosaic_channel(mosaic, x, y));
  return (radiance.at(x, y, 0) + radiance.at(x, y, 1) + radiance.at(x, y, 2)) / 3.0;
}

std::vector<std::uint16_t> SimulatedSensor::expose(const Image& radiance, const CameraSettings& applied,
                                                   std::uint64_t noise_key, double light_share,
                                                   double warming_k) const {
  const SensorDescription& sensor = camera_.sensor;
  const int width = camera_.limits.width_px, height = camera_.limits.height_px;
  const double gain = std::pow(10.0, applied.gain_db / 20.0);
  const double response = settings_.response_e_per_s_per_radiance * light_share;
  const double top = std::exp2(camera_.limits.bits) - 1.0;
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      CounterRandom random(noise_key, pixel);
      const double rate = response * radiance_seen(radiance, x, y) + dark_current_e_per_s(x, y, warming_k);
      const double collected = std::min(random.poisson(rate * applied.exposure_s), sensor.full_well_e);
      const double read = collected + sensor.read_noise_e * random.normal();
      const double shown = settings_.response == SensorResponse::Linear
                               ? read
                               : sensor.full_well_e * response_at(settings_.response, read / sensor.full_well_e);
      const double dn = std::round(sensor.black_level_dn + gain * shown / sensor.electrons_per_dn);
      samples[pixel] = static_cast<std::uint16_t>(std::clamp(dn, 0.0, top));
    }
  });
  return samples;
}

}  // namespace lumitexel
