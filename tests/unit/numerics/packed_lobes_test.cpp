#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "processing/brdf/evaluate_packed.h"
#include "processing/brdf/numerics/synthetic_observations.h"

namespace lumitexel {
namespace {

struct Scene {
  std::vector<LobeGeometry> geometries;
  PackedGeometries packed;

  explicit Scene(std::size_t count, std::uint64_t seed = 1) {
    RandomNumbers random(seed);
    for (std::size_t i = 0; i < count; ++i) add(random_sample(shiny_brdf(0.1, 1.0, 30.0), 0.0, random).geometry);
  }
  void add(const LobeGeometry& geometry) {
    geometries.push_back(geometry);
    packed.add(geometry);
  }
};

Brdf two_lobes(BrdfFamily family) {
  Brdf brdf{family, 3, {0.1, 0.2, 0.3}, std::vector<std::array<Lobe, kMaxChannels>>(2)};
  const bool aims = family == BrdfFamily::Lafortune;
  const double log_shape = aims ? 4.0 : -1.5, strength = aims ? 0.5 : -3.0;
  brdf.lobes[0] = {Lobe{strength, log_shape, 0.7}, Lobe{strength - 1.0, log_shape, 0.7}, Lobe{strength, log_shape + 0.5, 0.8}};
  brdf.lobes[1].fill({strength - 2.0, log_shape - 0.7, aims ? -0.7 : kMirrorAim});
  brdf.lobes[1][1].log_strength = -std::numeric_limits<double>::infinity();
  return brdf;
}

// Several lobes, channels that share shapes and that do not, one lobe off: as evaluate() one by one. Floats add up what each lobe
// may err.
TEST(PackedLobes, AreTheBrdfInEveryChannel) {
  constexpr double kTolerance = 4e-6;
  const Scene scene(1003);
  for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) {
    const Brdf brdf = two_lobes(family);
    std::vector<float> values(3 * scene.packed.size());
    evaluate(brdf, scene.packed, values);
    for (std::size_t i = 0; i < scene.packed.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double wanted = evaluate(brdf, c, scene.geometries[i]);
        EXPECT_NEAR(values[static_cast<std::size_t>(c) * scene.packed.size() + i], wanted, kTolerance * wanted) << to_string(family);
      }
    }
  }
}

TEST(PackedLobes, HaveTheSameBytesOnEveryWidth) {
  for (const std::size_t count : {1u, 15u, 16u, 17u, 255u, 256u, 257u, 5000u}) {
    const Scene scene(count, count);
    for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) {
      std::vector<float> scalar(3 * count), wide(3 * count);
      evaluate(two_lobes(family), scene.packed, scalar, VectorWidth::Scalar);
      for (const VectorWidth width : {VectorWidth::Avx2, VectorWidth::Avx512}) {
        if (width > widest_vectors()) continue;
        evaluate(two_lobes(family), scene.packed, wide, width);
        EXPECT_EQ(std::memcmp(scalar.data(), wide.data(), scalar.size() * sizeof(float)), 0) << to_string(family) << ", " << count;
      }
    }
  }
}

TEST(PackedLobes, SlopesHaveTheSameBytesOnEveryWidth) {
  const Scene scene(777);
  const auto slopes = [&](VectorWidth width) {
    std::vector<float> all(3 * scene.packed.size());
    const std::span<float> parts(all);
    lafortune_slopes({0.3, 4.2, 0.71}, scene.packed, {parts.first(777), parts.subspan(777, 777), parts.last(777)}, width);
    return all;
  };
  const std::vector<float> scalar = slopes(VectorWidth::Scalar);
  for (const VectorWidth width : {VectorWidth::Avx2, VectorWidth::Avx512}) {
    if (width > widest_vectors()) continue;
    EXPECT_EQ(std::memcmp(scalar.data(), slopes(width).data(), scalar.size() * sizeof(float)), 0);
  }
}

TEST(PackedLobes, AreDarkBelowTheSurface) {
  Scene scene(0);
  scene.add(geometry_of_cosines(0.1, -0.2, 0.5));
  scene.add(geometry_of_cosines(0.1, 0.5, -0.2));
  scene.add(geometry_of_cosines(0.1, 0.0, 0.5));
  for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) {
    std::vector<float> values(9, 1.0f);
    evaluate(two_lobes(family), scene.packed, values);
    for (const float value : values) EXPECT_EQ(value, 0.0f) << to_string(family);
  }
}

TEST(PackedLobes, RefuseTheWrongNumberOfValues) {
  const Scene scene(5);
  std::vector<float> values(14);
  EXPECT_THROW(evaluate(two_lobes(BrdfFamily::Lafortune), scene.packed, values), std::invalid_argument);
}

}  // namespace
}  // namespace lumitexel
