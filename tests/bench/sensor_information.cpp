#include "tests/bench/sensor_information.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kNormalFrom_e = 200.0;

double normal_density(double x, double variance) {
  return std::exp(-0.5 * x * x / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}
double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// The normal limit: electrons below the full well, given what was read, are normal again, which leaves a closed form.
double density_bright(double read_e, double mean_e, double read_variance, double full_well_e) {
  const double variance = mean_e + read_variance;
  const double given_mean = mean_e + mean_e / variance * (read_e - mean_e);
  const double given_sigma = std::sqrt(mean_e * read_variance / variance);
  const double below = normal_density(read_e - mean_e, variance) * normal_cdf((full_well_e - given_mean) / given_sigma);
  const double full = 1.0 - normal_cdf((full_well_e - mean_e) / std::sqrt(mean_e));
  return below + full * normal_density(read_e - full_well_e, read_variance);
}

double information_bright(double mean_e, double read_variance, double full_well_e) {
  const double sigma = std::sqrt(mean_e + read_variance);
  const double from = std::min(mean_e, full_well_e) - 9.0 * sigma, to = std::min(mean_e + 9.0 * sigma, full_well_e + 9.0 * std::sqrt(read_variance));
  const double step = std::sqrt(read_variance) / 20.0, delta = 1e-3 * sigma;
  double information = 0.0;
  for (double x = from; x < to; x += step) {
    const double p = density_bright(x, mean_e, read_variance, full_well_e);
    if (p < 1e-100) continue;
    const double slope = (density_bright(x, mean_e + delta, read_variance, full_well_e) -
                          density_bright(x, mean_e - delta, read_variance, full_well_e)) /
                         (2.0 * delta);
    information += slope * slope / p * step;
  }
  return information;
}

double information_dim(double mean_e, double read_variance) {
  const int most = static_cast<int>(mean_e + 12.0 * std::sqrt(mean_e) + 20.0);
  const double reach = 9.0 * std::sqrt(read_variance), step = std::sqrt(read_variance) / 20.0;
  double information = 0.0;
  for (double x = -reach; x < most + reach; x += step) {
    double p = 0.0, slope = 0.0, chance = std::exp(-mean_e), before = 0.0;
    for (int n = 0; n <= most; ++n) {
      const double read = normal_density(x - n, read_variance);
      p += chance * read;
      slope += (before - chance) * read;
      before = chance;
      chance *= mean_e / (n + 1);
    }
    if (p > 1e-100) information += slope * slope / p * step;
  }
  return information;
}

}  // namespace

double sample_information(double mean_e, const SensorNoise& noise) {
  const double read_variance =
      noise.read_noise_e * noise.read_noise_e + noise.electrons_per_dn * noise.electrons_per_dn / 12.0;
  return mean_e < kNormalFrom_e ? information_dim(mean_e, read_variance)
                                : information_bright(mean_e, read_variance, noise.full_well_e);
}

}  // namespace lumitexel
