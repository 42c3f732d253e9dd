#include "tests/unit/families/known_brdfs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

LobeGeometry random_geometry(bool near_mirror, std::mt19937& random) {
  constexpr double kPi = std::numbers::pi;
  std::uniform_real_distribution<double> theta(0.0, 1.3), azimuth(0.0, 2.0 * kPi), spread(-0.3, 0.3);
  const double theta_i = theta(random), azimuth_i = azimuth(random);
  const double theta_o = near_mirror ? std::abs(theta_i + spread(random)) : theta(random);
  const double azimuth_o = near_mirror ? azimuth_i + kPi + spread(random) : azimuth(random);
  return lobe_geometry(Eigen::Vector3d::UnitZ(), direction(theta_i, azimuth_i), direction(std::min(1.35, theta_o), azimuth_o));
}

// Standard normal numbers for one sample's channels.
Eigen::Vector3d channel_noise(NoiseKind kind, const Eigen::Vector3d& of_lumitexel, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double common = normal(random);
  Eigen::Vector3d own;
  for (double& value : own) value = normal(random);
  if (kind == NoiseKind::ChannelsTogether) return std::sqrt(0.9) * Eigen::Vector3d::Constant(common) + std::sqrt(0.1) * own;
  if (kind == NoiseKind::LumitexelTogether) return std::sqrt(0.5) * (of_lumitexel + own);
  return own;
}

}  // namespace

Brdf known_brdf(BrdfFamily family, const std::vector<KnownLobe>& lobes) {
  Brdf brdf;
  brdf.family = family;
  brdf.diffuse = {0.2, 0.15, 0.1};
  for (const KnownLobe& lobe : lobes) {
    auto& channels = brdf.lobes.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      channels[c] = {std::log(lobe.strength * (1.0 + 0.2 * static_cast<double>(c))), std::log(lobe.shape), lobe.aim};
    }
  }
  return brdf;
}

NoisySamples noisy_samples(const Brdf& truth, int lumitexels, double noise, NoiseKind kind, unsigned seed) {
  constexpr int kSamples = 5;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  NoisySamples result;
  for (int l = 0; l < lumitexels; ++l) {
    const Eigen::Vector3d of_lumitexel(normal(random), normal(random), normal(random));
    for (int s = 0; s < kSamples; ++s) {
      Observation& sample = result.observations.emplace_back();
      sample.geometry = random_geometry(s < 2, random);
      const Eigen::Vector3d z = channel_noise(kind, of_lumitexel, random);
      const ChannelValues r = predicted_reflectance(truth, sample.geometry);
      for (std::size_t c = 0; c < 3; ++c) {
        sample.reflectance[c] = static_cast<float>(r[c] * (1.0 + noise * z[static_cast<Eigen::Index>(c)]));
      }
    }
  }
  for (std::size_t i = 0; i < result.observations.size(); ++i) {
    result.samples.push_back({&result.observations[i], 1.0, static_cast<std::uint32_t>(i / kSamples)});
  }
  return result;
}

std::vector<LobeGeometry> some_directions(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<LobeGeometry> geometries;
  for (int i = 0; i < count; ++i) geometries.push_back(random_geometry(i % 2 == 0, random));
  return geometries;
}

}  // namespace lumitexel
