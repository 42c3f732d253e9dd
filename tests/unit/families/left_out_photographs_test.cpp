// A lobe has to pay in photographs that it was not fitted to.
#include "processing/brdf/left_out_photographs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "processing/brdf/choice.h"
#include "processing/brdf/misfit.h"
#include "tests/unit/families/known_brdfs.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr int kLumitexels = 300, kSeeds = 20;
constexpr double kNoise = 0.02;

const Brdf kMatte = one_lobe({0.1, 0.08, 0.05}, {1e-9, 1e-9, 1e-9}, kMirrorAim, 20.0);
Brdf glossy(double peak, double exponent) { return one_lobe({0.1, 0.08, 0.05}, {peak, peak, peak}, kMirrorAim, exponent); }

// What the samples of one photograph err by together, relative, one sigma: as a whole, and rising across the surface from one side to the other,
// as under a lamp that is not where it is said to be.
struct Together {
  double level = 0, slope = 0;
};

struct Photographed {
  std::vector<Observation> observations;
  std::vector<FitSample> samples;
};

Eigen::Vector3d above(double most_polar, std::mt19937& random) {
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI), cosine(std::cos(most_polar), 1.0);
  const double azimuth = turn(random), z = cosine(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

// Lumitexels of all normals within 60 degrees of upright in photographs that each have one camera and one lamp, far away.
Photographed photographed(const Brdf& truth, int views, const Together& together, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Photographed result;
  for (int view = 0; view < views; ++view) {
    const Eigen::Vector3d wi = above(1.2, random), wo = above(1.2, random);
    const double level = together.level * normal(random);
    const Eigen::Vector3d slope = together.slope * Eigen::Vector3d(normal(random), normal(random), normal(random));
    for (int l = 0; l < kLumitexels; ++l) {
      Observation sample;
      const Eigen::Vector3d up = above(1.05, random);
      sample.geometry = lobe_geometry(up, wi, wo);
      if (sample.geometry.cos_i < 0.1 || sample.geometry.cos_o < 0.1) continue;
      const double brightness = std::exp(level + slope.dot(up));
      for (int c = 0; c < 3; ++c) {
        const double value = predicted_reflectance(truth, c, sample.geometry) * brightness;
        sample.reflectance[static_cast<std::size_t>(c)] = static_cast<float>(value * (1.0 + kNoise * normal(random)));
      }
      result.observations.push_back(sample);
      result.samples.push_back({nullptr, 1.0, static_cast<std::uint32_t>(result.observations.size()), static_cast<std::uint16_t>(view)});
    }
  }
  for (std::size_t s = 0; s < result.samples.size(); ++s) result.samples[s].observation = &result.observations[s];
  return result;
}

MaterialFitOptions known_noise() {
  MaterialFitOptions options;
  options.error = ErrorModel(kNoise, 1e-4);
  options.estimate_error = false;
  return options;
}

struct Rates { int bic = 0, z1 = 0, z15 = 0, z2 = 0, m1 = 0, m15 = 0, m2 = 0, m25=0; };

TEST(LeftOutPhotographs, DISABLED_Research) {
  struct World { const char* name; Brdf truth; Together together; bool est; };
  std::vector<World> worlds;
  for (bool est : {false, true}) {
  worlds.push_back({"matte level .1", kMatte, {0.1, 0.0}, est});
  worlds.push_back({"matte slope .1", kMatte, {0.0, 0.1}, est});
  worlds.push_back({"matte both .1", kMatte, {0.1, 0.1}, est});
  worlds.push_back({"glossy .3 20", glossy(0.3,20), {0.1, 0.1}, est});
  worlds.push_back({"glossy .1 20", glossy(0.1,20), {0.1, 0.1}, est});
  worlds.push_back({"glossy .05 20", glossy(0.05,20), {0.1, 0.1}, est});
  worlds.push_back({"glossy .03 20", glossy(0.03,20), {0.1, 0.1}, est});
  worlds.push_back({"glossy .02 20", glossy(0.02,20), {0.1, 0.1}, est});
  worlds.push_back({"glossy .3 300", glossy(0.3,300), {0.1, 0.1}, est});
  worlds.push_back({"glossy .1 300", glossy(0.1,300), {0.1, 0.1}, est});
  }
  const int seeds = std::getenv("SEEDS") ? std::atoi(std::getenv("SEEDS")) : 20;
  for (const World& w : worlds) for (int views : {6, 12, 24}) {
    if (std::getenv("VIEWS") && std::atoi(std::getenv("VIEWS")) != views) continue;
    Rates r;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Photographed data = photographed(w.truth, views, w.together, static_cast<unsigned>(seed));
      MaterialFitOptions none = known_noise(), one = known_noise();
      none.estimate_error = one.estimate_error = w.est;
      none.most_lobes = 0; one.choose_lobes = false;
      const MaterialFit a = fit_material(data.samples, 3, nullptr, none), b = fit_material(data.samples, 3, nullptr, one);
      const double independence = w.est ? b.model.error.independence : 1.0;
      const double ca = independence * misfit(a.model.brdf, FitSamples(data.samples), a.model.error) + 3 * std::log(independence * static_cast<double>(data.samples.size()));
      const double cb = independence * misfit(b.model.brdf, FitSamples(data.samples), b.model.error) + 8 * std::log(independence * static_cast<double>(data.samples.size()));
      if (!(cb < ca)) continue;
      ++r.bic;
      const PhotographMisfits m = misfits_of_left_out(a.model, b.model, data.samples, one);
      const PairedDifference z = paired_difference(m.of_smaller, m.of_richer), p = paired_difference(m.of_smaller, m.of_richer, Judges::Photographs);
      r.z1 += z.sum > 1.0 * z.sigma; r.z15 += z.sum > 1.5 * z.sigma; r.z2 += z.sum > 2.0 * z.sigma;
      r.m1 += p.sum > 1.0 * p.sigma; r.m15 += p.sum > 1.5 * p.sigma; r.m2 += p.sum > 2.0 * p.sigma; r.m25 += p.sum > 2.5 * p.sigma;
    }
    std::printf("%d %-16s views %2d: bic %3d | zero 1 %3d 1.5 %3d 2 %3d | mean 1 %3d 1.5 %3d 2 %3d 2.5 %3d\n", w.est, w.name, views, r.bic, r.z1, r.z15, r.z2, r.m1, r.m15, r.m2, r.m25);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace lumitexel
