// From radiance to sensor integers.
//
//   mean electrons = response * exposure * radiance + dark current * exposure
//   electrons      = Poisson(mean), at most full_well_e, + Gaussian(read_noise_e)
//   sample         = round(black_level + gain * electrons / electrons_per_dn), in [0, 2^bits - 1]
//
// or, for a sensor that is not linear, with full_well_e * response_at(electrons / full_well_e) for the electrons in the last
// line. The dark current doubles every dark_current_doubling_k; a seeded share of the pixels is hot, with exponentially
// distributed currents. A mono sensor sees the mean of the three channels.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/camera.h"
#include "processing/image/image.h"
#include "rig/rig_description.h"
#include "sim/simulation_settings.h"

namespace lumitexel {

class SimulatedSensor {
 public:
  SimulatedSensor(const CameraDescription& camera, const SimulationSettings& settings);

  // radiance: three channels, of the camera's size. light_share: a factor on it; warming_k: above the settings' temperature.
  // Equal arguments give equal samples, in any thread.
  std::vector<std::uint16_t> expose(const Image& radiance, const CameraSettings& applied, std::uint64_t noise_key,
                                    double light_share = 1.0, double warming_k = 0.0) const;
  double dark_current_e_per_s(int x, int y, double warming_k = 0.0) const;
  bool is_hot(int x, int y) const;

 private:
  double radiance_seen(const Image& radiance, int x, int y) const;

  CameraDescription camera_;
  SimulationSettings settings_;
};

}  // namespace lumitexel
