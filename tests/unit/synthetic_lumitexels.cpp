#include "tests/unit/synthetic_lumitexels.h"

#include <cmath>

namespace lumitexel {
namespace {

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

}  // namespace

Brdf one_lobe(std::array<double, 3> diffuse, std::array<double, 3> peak, double phi, double exponent) {
  Brdf brdf;
  brdf.channels = 3;
  brdf.diffuse = diffuse;
  brdf.lobes.resize(1);
  for (std::size_t c = 0; c < 3; ++c) brdf.lobes[0][c] = {std::log(peak[c]), std::log(exponent), phi};
  return brdf;
}

void add_lumitexels(Observations& observations, const Brdf& truth, int count, int samples, double noise,
                    std::mt19937& random) {
  std::uniform_real_distribution<double> theta(0.0, 1.2), azimuth(0.0, 2.0 * M_PI), spread(-0.25, 0.25);
  std::normal_distribution<double> normal(0.0, 1.0);
  observations.channels = 3;
  for (int i = 0; i < count; ++i) {
    for (int s = 0; s < samples; ++s) {
      const double theta_i = theta(random), azimuth_i = azimuth(random);
      const bool near_mirror = s % 2 == 0;
      const double theta_o = near_mirror ? std::abs(theta_i + spread(random)) : theta(random);
      const double azimuth_o = near_mirror ? azimuth_i + M_PI + spread(random) : azimuth(random);
      Observation sample;
      sample.geometry = lobe_geometry(Eigen::Vector3d::UnitZ(), direction(theta_i, azimuth_i), direction(theta_o, azimuth_o));
      for (int c = 0; c < 3; ++c) {
        const double value = predicted_reflectance(truth, c, sample.geometry);
        sample.reflectance[static_cast<std::size_t>(c)] = static_cast<float>(value * (1.0 + noise * normal(random)));
      }
      observations.samples.push_back(sample);
    }
    observations.first.push_back(observations.samples.size());
  }
}

}  // namespace lumitexel
