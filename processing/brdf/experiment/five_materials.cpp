#include "processing/brdf/experiment/five_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "processing/brdf/experiment/dice.h"
#include "processing/brdf/experiment/label_bound.h"
#include "processing/brdf/experiment/parameter_bound.h"

namespace lumitexel {
namespace {

constexpr double kDiffuse[] = {0.15, 0.3, 0.1};
constexpr double kExponents[] = {36.2, 42.2, 48.2, 54.2, 60.2};
constexpr double kUnevenShares[] = {0.10, 0.55, 0.06, 0.25, 0.04};
constexpr double kLeastCosine = 0.1, kLeastViewCosine = 0.42;

Brdf material(double exponent) {
  Brdf brdf;
  auto& lobe = brdf.lobes.emplace_back();
  for (std::size_t c = 0; c < 3; ++c) {
    brdf.diffuse[c] = kDiffuse[c];
    lobe[c] = {std::log((exponent + 2.0) / (2.0 * std::numbers::pi)), std::log(exponent), kMirrorAim};  // all energy alike
  }
  return brdf;
}

Eigen::Vector3d upward(Dice& dice, double least_cosine) {
  const double z = dice.uniform(least_cosine, 1.0), turn = dice.uniform(0.0, 2.0 * std::numbers::pi), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

int draw_label(Dice& dice, int lumitexel, bool even) {
  if (even) return lumitexel % 5;
  double left = dice.uniform(0.0, 1.0);
  for (int k = 0; k < 4; ++k) {
    left -= kUnevenShares[k];
    if (left < 0.0) return k;
  }
  return 4;
}

void measure(const Brdf& truth, const FiveMaterialsOptions& options, Dice& dice, Observation& sample) {
  const double wrong = dice.uniform(0.0, 1.0) < options.outliers ? dice.uniform(0.0, kMostOutlierFactor) : 1.0;
  const auto draw = [&] { return options.gaussian ? dice.normal() / std::numbers::sqrt3 : dice.uniform(-1.0, 1.0); };
  const ChannelValues exact = predicted_reflectance(truth, sample.geometry);
  for (std::size_t c = 0; c < 3; ++c) {
    sample.reflectance[c] = static_cast<float>(exact[c] * (1.0 + options.noise * draw()) * wrong);
  }
}

// Materials in the order of their exponents: which is whose. Matte ones come first.
std::vector<std::size_t> by_exponent(const Clustering& clustering) {
  std::vector<std::size_t> order(clustering.materials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto exponent = [&](std::size_t k) {
    const Brdf& brdf = clustering.materials[k].model.brdf;
    return brdf.lobes.empty() ? -1e9 : brdf.lobes[0][0].log_shape;
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return exponent(a) < exponent(b); });
  return order;
}

// The same errors in the wider bounds of who is told no labels.
void add_unlabelled(FiveMaterialsScore& result, std::size_t k, const MaterialBound& labelled, const MaterialBound& unlabelled) {
  const double narrower = labelled.log_exponent / unlabelled.log_exponent;
  result.squared_exponent_unlabelled += std::pow(result.log_exponent_error[k] * narrower, 2) / 5.0;
  for (std::size_t c = 0; c < 3; ++c) {
    result.squared_diffuse_unlabelled += std::pow(result.diffuse_error[k][c] * labelled.diffuse[c] / unlabelled.diffuse[c], 2) / 15.0;
  }
}

}  // namespace

std::vector<Brdf> five_materials_truth() {
  std::vector<Brdf> truth;
  for (const double exponent : kExponents) truth.push_back(material(exponent));
  return truth;
}

std::vector<double> material_shares(const FiveMaterials& world) {
  std::vector<double> shares(world.truth.size(), 0.0);
  for (const int label : world.label) shares[static_cast<std::size_t>(label)] += 1.0 / static_cast<double>(world.label.size());
  return shares;
}

FiveMaterials make_five_materials(std::uint64_t seed, const FiveMaterialsOptions& options) {
  if (options.gaussian && options.outliers > 0.0) throw std::invalid_argument("five materials: outliers come with uniform noise only");
  Dice dice(seed * 7919 + 13);
  FiveMaterials world;
  world.seed = seed;
  world.options = options;
  world.observations.channels = 3;
  world.relative_sigma = options.noise / std::numbers::sqrt3;
  world.truth = five_materials_truth();
  std::array<Eigen::Vector3d, 5> views;
  for (Eigen::Vector3d& view : views) view = upward(dice, kLeastViewCosine);
  for (int i = 0; i < options.lumitexels; ++i) {
    world.label.push_back(draw_label(dice, i, options.even));
    for (int s = 0; s < options.samples_each; ++s) {
      Observation sample;
      const auto view = static_cast<std::size_t>(dice.uniform(0.0, 5.0));
      sample.geometry = lobe_geometry(Eigen::Vector3d::UnitZ(), upward(dice, kLeastCosine), views[std::min<std::size_t>(view, 4)]);
      measure(world.truth[static_cast<std::size_t>(world.label.back())], options, dice, sample);
      world.observations.samples.push_back(sample);
    }
    world.observations.first.push_back(world.observations.samples.size());
  }
  return world;
}

FiveMaterialsScore score(const FiveMaterials& world, const Clustering& clustering) {
  FiveMaterialsScore result;
  result.found = static_cast<int>(clustering.materials.size());
  result.bayes_accuracy = bayes_accuracy(world);
  result.normal_accuracy = accuracy_by_normal_noise(world);
  result.worst_exponent = result.worst_diffuse = std::numeric_limits<double>::infinity();
  if (clustering.materials.size() != world.truth.size()) return result;
  const std::vector<std::size_t> order = by_exponent(clustering);
  const std::vector<MaterialBound> labelled = bound_with_labels(world);
  std::vector<MaterialBound> unlabelled;
  if (world.options.gaussian) {
    unlabelled = bound_without_labels(world);
    result.squared_exponent_unlabelled = result.squared_diffuse_unlabelled = 0.0;
  }
  result.chance_at_bound = chance_within(kPaperError, unlabelled.empty() ? labelled : unlabelled, world.truth);
  std::vector<int> truth_of(order.size());
  result.all_found = true;
  result.fitted.resize(order.size());
  result.worst_exponent = result.worst_diffuse = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    truth_of[order[k]] = static_cast<int>(k);
    const Brdf& fitted = clustering.materials[order[k]].model.brdf;
    const MaterialBound& bound = labelled[k];
    result.fitted[k] = fitted;
    const double exponent = fitted.lobes.empty() ? 0.0 : std::exp(fitted.lobes[0][0].log_shape);
    const double half_gap = 0.5 * (kExponents[1] - kExponents[0]);
    if (std::abs(exponent - kExponents[k]) > half_gap) result.all_found = false;
    result.log_exponent_error[k] = std::log(std::max(1e-3, exponent) / kExponents[k]) / bound.log_exponent;
    result.worst_exponent = std::max(result.worst_exponent, std::abs(exponent / kExponents[k] - 1.0));
    result.squared_exponent += std::pow(result.log_exponent_error[k], 2) / 5.0;
    for (std::size_t c = 0; c < 3; ++c) {
      result.worst_diffuse = std::max(result.worst_diffuse, std::abs(fitted.diffuse[c] / kDiffuse[c] - 1.0));
      result.diffuse_error[k][c] = (fitted.diffuse[c] - kDiffuse[c]) / bound.diffuse[c];
      result.squared_diffuse += std::pow(result.diffuse_error[k][c], 2) / 15.0;
    }
    if (!unlabelled.empty()) add_unlabelled(result, k, bound, unlabelled[k]);
  }
  double right = 0.0;
  for (std::size_t l = 0; l < world.label.size(); ++l) {
    right += truth_of[static_cast<std::size_t>(clustering.label[l])] == world.label[l];
  }
  result.accuracy = right / static_cast<double>(world.label.size());
  return result;
}

}  // namespace lumitexel
