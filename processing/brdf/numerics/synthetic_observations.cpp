#include "processing/brdf/numerics/synthetic_observations.h"

#include <Eigen/Core>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kPi = 3.141592653589793;

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

void measure(const Brdf& truth, double noise, RandomNumbers& random, Observation& sample) {
  const ChannelValues values = predicted_reflectance(truth, sample.geometry);
  for (std::size_t c = 0; c < kMaxChannels; ++c) {
    sample.reflectance[c] = static_cast<float>(values[c] * (1.0 + (noise > 0.0 ? noise * random.normal() : 0.0)));
  }
}

}  // namespace

Brdf shiny_brdf(double diffuse, double peak, double exponent) {
  Brdf brdf{BrdfFamily::Lafortune, 3, {diffuse, 0.8 * diffuse, 0.6 * diffuse}, std::vector<std::array<Lobe, kMaxChannels>>(1)};
  brdf.lobes[0].fill({std::log(peak), std::log(exponent), kMirrorAim});
  return brdf;
}

Observation random_sample(const Brdf& truth, double noise, RandomNumbers& random) {
  DirectionPair pair{random.uniform(0.0, 1.2), random.uniform(0.0, 1.2), random.uniform(0.0, 2.0 * kPi)};
  if (random.uniform() < 0.5) pair = {pair.theta_i, std::abs(pair.theta_i + random.uniform(-0.25, 0.25)), kPi + random.uniform(-0.25, 0.25)};
  Observation sample;
  sample.geometry = lobe_geometry(Eigen::Vector3d::UnitZ(), direction(pair.theta_i, 0.0), direction(pair.theta_o, pair.azimuth));
  measure(truth, noise, random, sample);
  return sample;
}

Observations random_observations(const Brdf& truth, std::size_t lumitexels, std::size_t samples, double noise, std::uint64_t seed) {
  RandomNumbers random(seed);
  Observations observations;
  observations.channels = truth.channels;
  observations.samples.reserve(lumitexels * samples);
  for (std::size_t i = 0; i < lumitexels; ++i) {
    for (std::size_t s = 0; s < samples; ++s) observations.samples.push_back(random_sample(truth, noise, random));
    observations.first.push_back(observations.samples.size());
  }
  return observations;
}

std::vector<FitSample> all_samples(const Observations& observations) {
  std::vector<FitSample> samples;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    for (const Observation& sample : observations.of(i)) samples.push_back({&sample, 1.0, static_cast<std::uint32_t>(i)});
  }
  return samples;
}

}  // namespace lumitexel
