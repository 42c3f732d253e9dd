#include "processing/render/lobe_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "processing/render/sample_sequence.h"
#include "processing/render/texel_brdf.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;

struct NamedLobe {
  const char* name;
  BrdfFamily family;
  double log_shape, aim, log_strength;
};
const NamedLobe kLobes[] = {
    {"lafortune mirror 30", BrdfFamily::Lafortune, std::log(30.0), kMirrorAim, std::log(2.0)},
    {"lafortune off mirror 12", BrdfFamily::Lafortune, std::log(12.0), 0.6, std::log(1.0)},
    {"lafortune retro 20", BrdfFamily::Lafortune, std::log(20.0), -kMirrorAim, std::log(1.0)},
    {"ggx 0.3", BrdfFamily::Ggx, std::log(0.3), kMirrorAim, std::log(0.2)},
    {"ggx 1", BrdfFamily::Ggx, 0.0, kMirrorAim, std::log(0.04)},
    {"ward 0.2", BrdfFamily::Ward, std::log(0.2), kMirrorAim, std::log(0.3)},
};

Brdf brdf_of(const NamedLobe& lobe) {
  Brdf brdf;
  brdf.family = lobe.family;
  brdf.lobes.resize(1);
  brdf.lobes[0].fill({lobe.log_strength, lobe.log_shape, lobe.aim});
  return brdf;
}

Eigen::Vector3d viewer(double angle) { return {std::sin(angle), 0.0, std::cos(angle)}; }

// A product of midpoint rules over the sphere: polar angle times azimuth.
constexpr int kSide = 600;

template <typename Function>
double over_sphere(double least_cosine, const Function& function) {
  double sum = 0.0;
  const double widest = std::acos(least_cosine);
  for (int i = 0; i < kSide; ++i) {
    const double polar = widest * (i + 0.5) / kSide;
    for (int j = 0; j < kSide; ++j) {
      const double azimuth = 2 * kPi * (j + 0.5) / kSide;
      sum += std::sin(polar) * function(Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                        std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  return sum * widest / kSide * 2 * kPi / kSide;
}

double quadrature_albedo(const Brdf& brdf, const Eigen::Vector3d& wo) {
  return over_sphere(0.0, [&](const Eigen::Vector3d& wi) {
    return wi.z() * evaluate(brdf, 0, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo));
  });
}

// Moments of what is drawn against the same integrals over the stated density: a wrong density or a wrong draw shows.
TEST(LobeSampling, DirectionsAreDrawnWithTheirDensity) {
  constexpr int kSamples = 1 << 14;
  for (const NamedLobe& lobe : kLobes) {
    for (const double angle : {0.2, 1.2}) {
      const LobeSampler sampler(lobe.family, lobe.log_shape, lobe.aim);
      const Eigen::Vector3d wo = viewer(angle);
      Eigen::Vector3d drawn = Eigen::Vector3d::Zero();
      double counted = 0.0;
      for (int i = 0; i < kSamples; ++i) {
        SampleSequence numbers(1, 2, 0, static_cast<std::uint32_t>(i));
        const Eigen::Vector3d wi = sampler.sample(wo, numbers.next());
        ASSERT_NEAR(wi.norm(), 1.0, 1e-9) << lobe.name;
        if (sampler.density(wo, wi) <= 0.0) continue;
        counted += 1.0 / kSamples;
        drawn += wi / kSamples;
      }
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      const double mass = over_sphere(-1.0, [&](const Eigen::Vector3d& wi) {
        const double density = sampler.density(wo, wi);
        moment += wi * std::sqrt(1.0 - wi.z() * wi.z()) * density * 2.0 * kPi * kPi / (kSide * kSide);
        return density;
      });
      // Stratified points converge faster than 1 / sqrt(N) = 0.8 %, the quadrature to a few 1e-4 at the visible rim.
      constexpr double kTolerance = 3e-3;
      EXPECT_NEAR(counted, mass, kTolerance) << lobe.name << " " << angle;
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(drawn[axis], moment[axis], kTolerance) << lobe.name << " " << angle << " " << axis;
    }
  }
}

TEST(LobeSampling, TheTabulatedEnergyOfALobeIsThatOfQuadrature) {
  for (const NamedLobe& lobe : kLobes) {
    const Brdf brdf = brdf_of(lobe);
    const ReflectingBrdf prepared(brdf);
    ASSERT_EQ(prepared.parts.size(), 1u) << "channels of one shape are one part";
    for (const double angle : {0.1, 0.7, 1.2}) {
      const double expected = quadrature_albedo(brdf, viewer(angle));
      EXPECT_NEAR(prepared.parts[0].albedo(std::cos(angle))[0], expected, 0.01 * expected) << lobe.name << " " << angle;
    }
  }
}

// The whole mixture: diffuse light and two lobes, in two materials that the texel mixes, under a tilted normal.
TEST(LobeSampling, ATexelsMixtureReflectsTheEnergyOfQuadrature) {
  Brdf first = brdf_of(kLobes[3]), second = brdf_of(kLobes[5]);
  first.diffuse = {0.1, 0.05, 0.02};
  Model model = model_of(square_mesh(), 1, 1, first);
  model.materials[0].basis = {first, second};
  model.weights = Image(1, 1, 2);
  model.weights.data = {0.7f, 0.4f};
  const ReflectingModel reflecting(model, FitStage::Pfa);
  TexelReflection texel(reflecting);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, 0.9).normalized(),
                        wo = Eigen::Vector3d(-0.5, 0.3, 0.6).normalized();
  ASSERT_TRUE(texel.set(0, 0, normal, wo));
  const double expected = 0.7f * quadrature_albedo(first, viewer(std::acos(normal.dot(wo)))) +
                          0.4f * quadrature_albedo(second, viewer(std::acos(normal.dot(wo))));
  constexpr int kSamples = 1 << 13;
  double energy = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    SampleSequence numbers(1, 2, 0, static_cast<std::uint32_t>(i));
    const double choice = numbers.next().x();
    const Eigen::Vector3d wi = texel.sample(choice, numbers.next());
    const double density = texel.density(wi);
    if (density > 0.0) energy += texel.reflectance(wi)[0] / density / kSamples;
  }
  EXPECT_NEAR(energy, expected, 0.01 * expected) << "1 / sqrt(8192) of a weight that is about 1";
  EXPECT_NEAR(texel.albedo()[0], expected, 0.01 * expected);
  EXPECT_FALSE(texel.set(0, 0, normal, -wo)) << "seen from below";
}

// Every stage that a model can be evaluated at, here with principal functions.
TEST(TexelReflection, IsTheModelsBrdfAtEveryStage) {
  Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(0.1, 0.2, 0.3));
  model.materials = {{brdf_of(kLobes[0]), {brdf_of(kLobes[3]), diffuse_brdf(0.1, 0.1, 0.1)}, {brdf_of(kLobes[5])}}};
  model.weights = Image(1, 1, 2);
  model.weights.data = {0.5f, 0.25f};
  model.projection_weights = Image(1, 1, 1, 0.75f);
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), wo = viewer(0.6), wi = viewer(-0.5);
  for (const FitStage stage : kFitStages) {
    const ReflectingModel reflecting(model, stage);
    TexelReflection texel(reflecting);
    ASSERT_TRUE(texel.set(0, 0, normal, wo));
    const double expected = wi.z() * evaluate_texel(model, stage, 0, 0, 1, lobe_geometry(normal, wi, wo));
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(texel.reflectance(wi)[1], expected, 1e-12 * expected) << to_string(stage);
  }
}

}  // namespace
}  // namespace lumitexel
