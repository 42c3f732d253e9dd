#include "processing/brdf/material_basis.h"

#include <algorithm>
#include <cmath>

#include "processing/brdf/lobe_family.h"
#include "processing/brdf/nnls.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostOthers = kMaxBasis - 1 - kVariations;
constexpr std::size_t kMostBordering = 3;
constexpr double kDiffuseFactor = 1.5, kExponentFactor = 1.5;

// The lobe sharper by a factor in exponent, or in 1 / alpha^2, which means the same of microfacets.
Brdf varied(const Brdf& brdf, double diffuse_factor, double exponent_factor) {
  const LobeFamily& family = lobe_family(brdf.family);
  const double step = brdf.family == BrdfFamily::Lafortune ? std::log(exponent_factor) : -0.5 * std::log(exponent_factor);
  Brdf result = brdf;
  for (double& kd : result.diffuse) kd *= diffuse_factor;
  for (auto& lobe : result.lobes) {
    for (auto& channel : lobe) {
      channel.log_shape = std::clamp(channel.log_shape + step, family.least_log_shape, family.most_log_shape);
    }
  }
  return result;
}

// Mean squared difference of square roots, over geometries that the session really has.
double distance(const Brdf& a, const Brdf& b, const Observations& observations) {
  const std::size_t stride = observations.samples.size() / 2000 + 1;
  double sum = 0.0;
  for (std::size_t s = 0; s < observations.samples.size(); s += stride) {
    for (int c = 0; c < observations.channels; ++c) {
      const double difference = std::sqrt(predicted_reflectance(a, c, observations.samples[s].geometry)) -
                                std::sqrt(predicted_reflectance(b, c, observations.samples[s].geometry));
      sum += difference * difference;
    }
  }
  return sum;
}

// The others in the order in which they are wanted.
std::vector<std::size_t> choose_others(std::size_t material, const std::vector<Brdf>& materials,
                                       const std::vector<std::size_t>& neighbours, const Observations& observations) {
  std::vector<std::size_t> others;
  for (std::size_t j = 0; j < materials.size(); ++j) {
    if (j != material) others.push_back(j);
  }
  if (others.size() <= kMostOthers) return others;
  std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) { return neighbours[a] > neighbours[b]; });
  std::vector<double> difference(materials.size());
  for (const std::size_t j : others) difference[j] = distance(materials[material], materials[j], observations);
  std::stable_sort(others.begin() + kMostBordering, others.end(),
                   [&](std::size_t a, std::size_t b) { return difference[a] < difference[b]; });
  others.resize(kMostOthers);
  return others;
}

}  // namespace

std::vector<std::vector<Brdf>> material_bases(const std::vector<Brdf>& materials,
                                                       const std::vector<std::vector<std::size_t>>& neighbour_counts,
                                                       const Observations& observations) {
  std::vector<std::vector<Brdf>> bases;
  for (std::size_t j = 0; j < materials.size(); ++j) {
    std::vector<Brdf> basis{materials[j], varied(materials[j], kDiffuseFactor, kExponentFactor),
                                     varied(materials[j], 1.0 / kDiffuseFactor, 1.0 / kExponentFactor)};
    for (const std::size_t other : choose_others(j, materials, neighbour_counts[j], observations)) {
      basis.push_back(materials[other]);
    }
    bases.push_back(std::move(basis));
  }
  return bases;
}

}  // namespace lumitexel
