// How many materials --materials auto finds on objects whose number is known, over seeds, for errors that invite it to find more: common
// to all channels, common to a lumitexel, or made by normals that the mesh does not have. Exits with 1 where a number is right in under 95 of 100.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "processing/brdf/cluster_materials.h"
#include "tests/bench/machine.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

struct Case {
  const char* name;
  int materials;
  double relative, of_channels, of_lumitexel;  // sigma of the error, and shares of its variance that go together
  double tilt_degrees;                         // rms of the normals' error
};

constexpr Case kCases[] = {
    {"one, errors independent", 1, 0.05, 0.0, 0.0, 0.0},     {"one, channels err together", 1, 0.05, 0.9, 0.0, 0.0},
    {"one, lumitexels err as one", 1, 0.05, 0.0, 0.6, 0.0},  {"one, normals off by 1 degree", 1, 0.02, 0.0, 0.0, 1.0},
    {"one, normals off by 4 degrees", 1, 0.02, 0.0, 0.0, 4.0}, {"three, errors independent", 3, 0.05, 0.0, 0.0, 0.0},
    {"three, channels err together", 3, 0.05, 0.9, 0.0, 0.0}, {"three, lumitexels err as one", 3, 0.05, 0.0, 0.6, 0.0},
    {"three, normals off by 4 degrees", 3, 0.02, 0.0, 0.0, 4.0}};

std::vector<Brdf> materials_of(const Case& c) {
  if (c.materials == 1) return {one_lobe({0.2, 0.1, 0.05}, {0.6, 0.6, 0.6}, kMirrorAim, 20.0)};
  return {one_lobe({0.20, 0.05, 0.04}, {0.3, 0.3, 0.3}, kMirrorAim, 8.0), one_lobe({0.04, 0.06, 0.20}, {1.5, 1.5, 1.5}, kMirrorAim, 60.0),
          one_lobe({0.01, 0.01, 0.01}, {3.0, 2.0, 1.0}, kMirrorAim, 25.0)};
}

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

// One lumitexel of six samples, half of them near its nominal highlight; the normal that the fit is told is not the true one.
void add_lumitexel(const Brdf& truth, const Case& c, std::mt19937& random, Observations& observations) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> theta(0.0, 1.2), azimuth(0.0, 2.0 * std::numbers::pi), spread(-0.25, 0.25);
  const double tilt = c.tilt_degrees * std::numbers::pi / 180.0 / std::numbers::sqrt2, of_all = normal(random);
  const Eigen::Vector3d bumpy = Eigen::Vector3d(tilt * normal(random), tilt * normal(random), 1.0).normalized();
  for (int s = 0; s < 6; ++s) {
    const double theta_i = theta(random), azimuth_i = azimuth(random);
    const Eigen::Vector3d wi = direction(theta_i, azimuth_i);
    const Eigen::Vector3d wo = s % 2 == 0 ? direction(std::abs(theta_i + spread(random)), azimuth_i + std::numbers::pi + spread(random))
                                          : direction(theta(random), azimuth(random));
    Observation sample;
    sample.geometry = lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo);
    const ChannelValues exact = predicted_reflectance(truth, lobe_geometry(bumpy, wi, wo));
    const double of_sample = normal(random), alone = 1.0 - c.of_channels - c.of_lumitexel;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double error = std::sqrt(c.of_lumitexel) * of_all + std::sqrt(c.of_channels) * of_sample + std::sqrt(alone) * normal(random);
      sample.reflectance[channel] = static_cast<float>(exact[channel] * (1.0 + c.relative * error));
    }
    observations.samples.push_back(sample);
  }
  observations.first.push_back(observations.samples.size());
}

std::size_t materials_found(const Case& c, unsigned seed) {
  std::mt19937 random(seed);
  Observations observations;
  observations.channels = 3;
  for (const Brdf& truth : materials_of(c)) {
    for (int i = 0; i < 100; ++i) add_lumitexel(truth, c, random, observations);
  }
  LumitexelList all(observations.lumitexels());
  std::iota(all.begin(), all.end(), std::size_t{0});
  ClusterOptions options;
  options.materials = 0;
  options.fit.error = ErrorModel(0.3, 0.02);
  return cluster_materials(observations, all, options, [](int) {}).materials.size();
}

constexpr double kLeastRight = 0.95;  // of the seeds

// Prints how many materials were found how often; whether the number was right often enough.
bool is_counted_right(const Case& c, int seeds) {
  std::map<std::size_t, int> counts;
  for (int seed = 1; seed <= seeds; ++seed) ++counts[materials_found(c, static_cast<unsigned>(seed))];
  const int right = counts[static_cast<std::size_t>(c.materials)];
  const bool enough = right >= kLeastRight * seeds;
  std::printf("%-34s right %3d of %d; found", c.name, right, seeds);
  for (const auto& [found, times] : counts) {
    if (times > 0) std::printf("  %zu: %d", found, times);
  }
  std::printf("%s\n", enough ? "" : "  TOO FEW");
  std::fflush(stdout);
  return enough;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  using namespace lumitexel;
  CLI::App app("Number of materials found on objects of one and of three materials, 100 lumitexels each");
  int seeds = 100;
  std::string only;
  app.add_option("--seeds", seeds)->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--only", only, "Objects whose description holds this");
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", machine_line().c_str());
  int too_few = 0;
  for (const Case& c : kCases) {
    if (std::string(c.name).find(only) != std::string::npos) too_few += !is_counted_right(c, seeds);
  }
  return too_few > 0 ? 1 : 0;
}
