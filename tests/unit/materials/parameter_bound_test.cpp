#include "processing/brdf/experiment/parameter_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "processing/brdf/experiment/mixture_score.h"

namespace lumitexel {
namespace {

FiveMaterials world_of(bool even, double noise = 0.05) {
  FiveMaterialsOptions options;
  options.gaussian = true;
  options.even = even;
  options.noise = noise;
  return make_five_materials(1, options);
}

// Root mean squares over the materials (and channels) of how much wider the bound is without labels.
struct Widening {
  double exponent = 0, diffuse = 0;
};

Widening widening(const FiveMaterials& world) {
  const std::vector<MaterialBound> wider = bound_without_labels(world), narrower = bound_with_labels(world);
  const auto count = static_cast<double>(wider.size());
  Widening squares;
  for (std::size_t k = 0; k < wider.size(); ++k) {
    squares.exponent += std::pow(wider[k].log_exponent / narrower[k].log_exponent, 2) / count;
    for (std::size_t c = 0; c < 3; ++c) squares.diffuse += std::pow(wider[k].diffuse[c] / narrower[k].diffuse[c], 2) / (3.0 * count);
  }
  return {std::sqrt(squares.exponent), std::sqrt(squares.diffuse)};
}

// What an independent simulation (another generator, 30 worlds, the score's outer products with fewer unknowns drawn) has: N 1.016 and kd 1.10 even,
// 1.016 and 1.11 uneven; worlds differ by 0.005, and this one is drawn to 0.005.
constexpr double kWorldsDiffer = 0.012;

TEST(ParameterBound, WithoutLabelsIsAsMuchWiderAsASimulationHasIt) {
  const Widening even = widening(world_of(true)), uneven = widening(world_of(false));
  EXPECT_NEAR(even.exponent, 1.016, kWorldsDiffer);
  EXPECT_NEAR(even.diffuse, 1.10, kWorldsDiffer);
  EXPECT_NEAR(uneven.exponent, 1.016, kWorldsDiffer);
  EXPECT_NEAR(uneven.diffuse, 1.11, kWorldsDiffer);
}

TEST(ParameterBound, LittleNoiseTellsTheLabels) {
  const Widening quiet = widening(world_of(true, 1e-3));  // nineteen lumitexels of twenty tell whose they are
  EXPECT_LT(quiet.exponent, 1.005);
  EXPECT_LT(quiet.diffuse, 1.03);
  EXPECT_GT(quiet.diffuse, 1.0);
}

TEST(ParameterBound, OfOneMaterialNobodyNeedsLabels) {
  FiveMaterials world = world_of(true);
  world.truth.resize(1);
  world.label.assign(world.label.size(), 0);
  EXPECT_NEAR(widening(world).exponent, 1.0, 1e-9);
  EXPECT_NEAR(widening(world).diffuse, 1.0, 1e-9);
}

// ln p of one lumitexel's samples from all unknowns, as the header of mixture_score.h has them, by the formulas themselves.
double log_mixture(const BrdfParameters& layout, const Eigen::VectorXd& unknowns, std::span<const Observation> samples, double relative_sigma,
                   const std::vector<SampleValues>& values) {
  const Eigen::Index own = layout.size(), count = (unknowns.size() + 1) / (own + 1);
  double p = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Brdf brdf = layout.brdf(unknowns.segment(k * own, own));
    double factor = k + 1 < count ? unknowns[count * own + k] : 1.0 - unknowns.tail(count - 1).sum();
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const ChannelValues exact = predicted_reflectance(brdf, samples[s].geometry);
      for (int c = 0; c < 3; ++c) {
        const double sigma = relative_sigma * exact[static_cast<std::size_t>(c)], off = (values[s][c] - exact[static_cast<std::size_t>(c)]) / sigma;
        factor *= std::exp(-0.5 * off * off) / sigma;
      }
    }
    p += factor;
  }
  return std::log(p);
}

TEST(ParameterBound, TheMixturesSlopeIsThatOfItsLogarithm) {
  const FiveMaterials world = world_of(false);
  const BrdfFamily family = world.truth[0].family;
  const BrdfParameters layout(family, 3, true, {widest_bounds(family)});
  const std::vector<double> shares = material_shares(world);
  Eigen::VectorXd unknowns(5 * layout.size() + 4);
  std::vector<BrdfSlopes> models;
  for (int k = 0; k < 5; ++k) {
    Eigen::VectorXd own = layout.from(world.truth[static_cast<std::size_t>(k)]);
    own[layout.aim(0, 0)] -= 0.01;  // at the mirror direction itself slopes differ on both sides
    unknowns.segment(k * layout.size(), layout.size()) = own;
    if (k < 4) unknowns[5 * layout.size() + k] = shares[static_cast<std::size_t>(k)];
    models.emplace_back(layout, own);
  }
  for (std::size_t lumitexel : {0u, 1u, 2u}) {
    const std::span<const Observation> samples = world.observations.of(lumitexel);
    std::vector<PredictedSamples> materials;
    for (const BrdfSlopes& model : models) materials.push_back(predicted_samples(model, samples));
    std::vector<SampleValues> values;
    for (const Observation& sample : samples) {
      values.push_back(SampleValues(3));
      for (int c = 0; c < 3; ++c) values.back()[c] = static_cast<double>(sample.reflectance[static_cast<std::size_t>(c)]);
    }
    const MixtureScore score = mixture_score(materials, shares, world.relative_sigma, values);
    EXPECT_NEAR(std::accumulate(score.probability.begin(), score.probability.end(), 0.0), 1.0, 1e-12);
    const Eigen::VectorXd slope = score.slope();
    constexpr double kStep = 1e-6;
    for (Eigen::Index u = 0; u < unknowns.size(); ++u) {
      Eigen::VectorXd up = unknowns, down = unknowns;
      up[u] += kStep;
      down[u] -= kStep;
      const double difference = (log_mixture(layout, up, samples, world.relative_sigma, values) -
                                 log_mixture(layout, down, samples, world.relative_sigma, values)) / (2.0 * kStep);
      EXPECT_NEAR(slope[u], difference, 1e-5 * std::max(10.0, slope.cwiseAbs().maxCoeff())) << lumitexel << ' ' << u;
    }
  }
}

TEST(ParameterBound, TheChanceAtTheBoundIsThatOfIndependentErrors) {
  const std::vector<Brdf> truth = five_materials_truth();
  std::vector<MaterialBound> bound(5, {1e-9, {1e-9, 1e-9, 1e-9}});
  EXPECT_NEAR(chance_within(0.002, bound, truth), 1.0, 1e-12);
  bound[1].log_exponent = 0.002;
  bound[4].diffuse[2] = 0.001 * truth[4].diffuse[2];
  EXPECT_NEAR(chance_within(0.002, bound, truth), 0.682689 * 0.954500, 1e-6);  // within one sigma, and within two
}

}  // namespace
}  // namespace lumitexel
