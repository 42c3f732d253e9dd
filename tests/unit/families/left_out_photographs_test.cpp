// A lobe has to pay in photographs that it was not fitted to.
#include "processing/brdf/left_out_photographs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/families/known_brdfs.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr int kViews = 6, kLumitexels = 300, kSeeds = 20;
constexpr double kNoise = 0.02;

Brdf glossy() { return one_lobe({0.1, 0.08, 0.05}, {0.3, 0.3, 0.3}, kMirrorAim, 20.0); }
Brdf matte() { return one_lobe({0.1, 0.08, 0.05}, {1e-9, 1e-9, 1e-9}, kMirrorAim, 20.0); }

struct Photographed {
  std::vector<Observation> observations;
  std::vector<FitSample> samples;
};

Eigen::Vector3d above(double most_polar, std::mt19937& random) {
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI), cosine(std::cos(most_polar), 1.0);
  const double azimuth = turn(random), z = cosine(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

// Lumitexels of all normals within 60 degrees of upright in photographs that each have one camera and one lamp, far away. `off`: how much each photograph as
// a whole is too bright or too dark, one sigma.
Photographed photographed(const Brdf& truth, double off, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Photographed result;
  for (int view = 0; view < kViews; ++view) {
    const Eigen::Vector3d wi = above(1.2, random), wo = above(1.2, random);
    const double brightness = 1.0 + off * normal(random);
    for (int l = 0; l < kLumitexels; ++l) {
      Observation sample;
      sample.geometry = lobe_geometry(above(1.05, random), wi, wo);
      if (sample.geometry.cos_i < 0.1 || sample.geometry.cos_o < 0.1) continue;
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

std::size_t lobes_of(const Photographed& data) {
  MaterialFitOptions options;
  options.error = ErrorModel(kNoise, 1e-4);
  options.estimate_error = false;
  return fit_material(data.samples, 3, nullptr, options).model.brdf.lobes.size();
}

int with_a_lobe(const Brdf& truth, double off, bool photographs_known) {
  int count = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Photographed data = photographed(truth, off, seed);
    for (FitSample& sample : data.samples) sample.view = photographs_known ? sample.view : std::uint16_t{0};
    count += lobes_of(data) == 1;
  }
  return count;
}

TEST(LeftOutPhotographs, AGlossySurfaceHasItsLobe) { EXPECT_EQ(with_a_lobe(glossy(), 0.0, true), kSeeds); }

// Photographs that are a tenth too bright or too dark: by the count of samples, each with its own small error, most such surfaces have a lobe. By
// photographs one standard error lets a sixth pass by chance, 3.3 of 20 seeds, give or take 1.7: twice as many are allowed.
TEST(LeftOutPhotographs, WrongBrightnessIsNoHighlight) {
  EXPECT_GE(with_a_lobe(matte(), 0.1, false), kSeeds / 2);
  EXPECT_LE(with_a_lobe(matte(), 0.1, true), kSeeds / 3);
}

}  // namespace
}  // namespace lumitexel
