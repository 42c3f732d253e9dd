// The same bytes for 1, 2 and 4 threads, from the fit of one material to every texel's weights.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <string>

#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/fit_material.h"
#include "processing/brdf/material_basis.h"
#include "processing/brdf/numerics/synthetic_observations.h"
#include "processing/brdf/project_weights.h"
#include "processing/brdf/select_lumitexels.h"

namespace lumitexel {
namespace {

class Bytes {
 public:
  template <typename Number>
  void add(const Number& number) {
    text_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void add(const Brdf& brdf) {
    for (const double kd : brdf.diffuse) add(kd);
    for (const auto& lobe : brdf.lobes) {
      for (const Lobe& channel : lobe) {
        add(channel.log_strength);
        add(channel.log_shape);
        add(channel.aim);
      }
    }
  }
  void add(const BrdfFit& fit) {
    add(fit.brdf);
    add(fit.misfit);
    add(fit.chi_squared);
    for (Eigen::Index i = 0; i < fit.covariance.size(); ++i) add(fit.covariance.data()[i]);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// More than one block of ordered_sum.h, so that threads have something to share.
Observations two_materials() {
  Observations all = random_observations(shiny_brdf(0.1, 1.0, 40.0), 220, 6, 0.05, 41);
  const Observations more = random_observations(shiny_brdf(0.3, 0.4, 10.0), 140, 6, 0.05, 42);
  const std::size_t before = all.samples.size();
  all.samples.insert(all.samples.end(), more.samples.begin(), more.samples.end());
  for (std::size_t i = 1; i < more.first.size(); ++i) all.first.push_back(before + more.first[i]);
  return all;
}

template <typename Work>
void expect_same_bytes(const Work& work) {
  std::string first;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    const std::string bytes = work();
    ASSERT_FALSE(bytes.empty());
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
}

TEST(Determinism, FitMaterial) {
  const Observations observations = two_materials();
  expect_same_bytes([&] {
    MaterialFitOptions options;
    options.most_lobes = 2;
    const MaterialFit fit = fit_material(all_samples(observations), 3, nullptr, options);
    Bytes bytes;
    bytes.add(fit.fit);
    bytes.add(fit.criterion);
    bytes.add(fit.model.error.relative);
    return bytes.text();
  });
}

TEST(Determinism, ClusterMaterials) {
  const Observations observations = two_materials();
  ClusterOptions options;
  options.materials = 2;
  expect_same_bytes([&] {
    const Clustering clustering = cluster_materials(observations, select_lumitexels(observations, 400), options, [](int) {});
    Bytes bytes;
    bytes.add(clustering.single.brdf);
    for (const FittedMaterial& material : clustering.materials) bytes.add(material.fit);
    for (const int label : clustering.label) bytes.add(label);
    return bytes.text();
  });
}

TEST(Determinism, PriorAndProjection) {
  const Observations observations = two_materials();
  const std::vector<Brdf> materials{shiny_brdf(0.1, 1.0, 40.0), shiny_brdf(0.3, 0.4, 10.0)};
  const std::vector<Brdf> basis = material_bases(materials, {{0, 1}, {1, 0}}, observations)[0];
  std::vector<std::size_t> members(220);
  for (std::size_t i = 0; i < members.size(); ++i) members[i] = i;
  expect_same_bytes([&] {
    const PriorChoice choice = choose_prior(observations, members, TexelBasis(basis, {}));
    std::vector<TexelWeights> weights(observations.lumitexels());
    oneapi::tbb::parallel_for(std::size_t{0}, weights.size(), [&](std::size_t i) {
      weights[i] = project_texel(observations.of(i), TexelBasis(basis, {}), {0.4, 0.1});
    });
    Bytes bytes;
    bytes.add(choice.prior.diffuse_width);
    bytes.add(choice.prior.gloss_width);
    bytes.add(choice.left_out_error);
    for (const TexelWeights& texel : weights) {
      for (const float weight : texel.weight) bytes.add(weight);
      bytes.add(texel.relative_sigma);
    }
    return bytes.text();
  });
}

}  // namespace
}  // namespace lumitexel
