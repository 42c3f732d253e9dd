#include "processing/brdf/projected_error.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/brdf/material_basis.h"
#include "processing/brdf/misfit.h"
#include "processing/brdf/prepared_brdf.h"
#include "processing/brdf/project_weights.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFolds = 4;           // of a lumitexel's samples
constexpr std::size_t kMostForPrior = 100;  // learners of a material: its two widths are a step of a coarse ladder each

struct Material {
  PreparedMisfit misfit;
  double log_share;
  TexelBasis basis;
  std::vector<PreparedBrdf> prepared;  // the basis
  TexelPrior prior = {};
};

std::vector<Material> materials_of(const Mixture& mixture, const Observations& observations) {
  std::vector<Brdf> brdfs;
  for (const MaterialModel& material : mixture.materials) brdfs.push_back(material.brdf);
  const std::vector<std::vector<std::size_t>> no_neighbours(brdfs.size(), std::vector<std::size_t>(brdfs.size(), 0));
  const auto bases = material_bases(brdfs, no_neighbours, observations);
  std::vector<Material> materials;
  for (std::size_t k = 0; k < brdfs.size(); ++k) {
    const ErrorModel& error = mixture.materials[k].error;
    materials.push_back({PreparedMisfit(brdfs[k], error), std::log(mixture.share[k]), TexelBasis(bases[k], error), {bases[k].begin(), bases[k].end()}});
  }
  return materials;
}

std::size_t most_probable(const std::vector<Material>& materials, std::span<const Observation> samples) {
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < materials.size(); ++k) {
    const double log_probability = materials[k].log_share - 0.5 * materials[k].misfit.of(samples);
    if (log_probability > most) {
      most = log_probability;
      best = k;
    }
  }
  return best;
}

void choose_priors(const Observations& observations, const LumitexelList& learners, std::vector<Material>& materials) {
  std::vector<std::size_t> label(learners.size());
  oneapi::tbb::parallel_for(std::size_t{0}, label.size(), [&](std::size_t l) { label[l] = most_probable(materials, observations.of(learners[l])); });
  std::vector<LumitexelList> members(materials.size());
  for (std::size_t l = 0; l < label.size(); ++l) members[label[l]].push_back(learners[l]);
  for (std::size_t k = 0; k < materials.size(); ++k) {
    materials[k].prior = choose_prior(observations, thinned(members[k], kMostForPrior), materials[k].basis).prior;
  }
}

SquaredError projected_error(const std::vector<Material>& materials, std::span<const Observation> samples, int channels, double clip) {
  SquaredError error;
  for (std::size_t fold = 0; fold < std::min(kFolds, samples.size()); ++fold) {
    std::vector<Observation> kept;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      if (s % kFolds != fold) kept.push_back(samples[s]);
    }
    const Material& material = materials[most_probable(materials, kept)];
    const TexelWeights weights = project_texel(kept, material.basis, material.prior);
    for (std::size_t s = fold; s < samples.size(); s += kFolds) {
      error += squared_error(predicted_reflectance(material.prepared, weights.weight, samples[s].geometry), samples[s], channels, clip);
    }
  }
  return error;
}

}  // namespace

std::vector<SquaredError> projected_errors(const Mixture& mixture, const Observations& observations, const LumitexelList& learners,
                                           const LumitexelList& asked, double clip) {
  std::vector<Material> materials = materials_of(mixture, observations);
  choose_priors(observations, learners, materials);
  std::vector<SquaredError> errors(asked.size());
  oneapi::tbb::parallel_for(std::size_t{0}, asked.size(), [&](std::size_t l) {
    const auto samples = observations.of(asked[l]);
    if (samples.size() >= 2) errors[l] = projected_error(materials, samples, observations.channels, clip);
  });
  return errors;
}

std::vector<SquaredError> projected_errors_by_photograph(const Mixture& mixture, const PhotographFold& fold, const LumitexelList& learners,
                                                         const LumitexelList& asked, std::size_t photographs, double clip) {
  std::vector<Material> materials = materials_of(mixture, fold.shown);
  choose_priors(fold.shown, learners, materials);
  const std::vector<std::size_t>& first = fold.left_out.first;
  std::vector<SquaredError> by_sample(fold.left_out.samples.size()), errors(photographs);
  oneapi::tbb::parallel_for(std::size_t{0}, asked.size(), [&](std::size_t l) {
    const auto shown = fold.shown.of(asked[l]);
    if (shown.empty() || first[asked[l]] == first[asked[l] + 1]) return;
    const Material& material = materials[most_probable(materials, shown)];
    const TexelWeights weights = project_texel(shown, material.basis, material.prior);
    for (std::size_t s = first[asked[l]]; s < first[asked[l] + 1]; ++s) {
      const Observation& sample = fold.left_out.samples[s];
      by_sample[s] = squared_error(predicted_reflectance(material.prepared, weights.weight, sample.geometry), sample, fold.left_out.channels, clip);
    }
  });
  for (std::size_t s = 0; s < by_sample.size(); ++s) errors[fold.left_out.view[s]] += by_sample[s];
  return errors;
}

}  // namespace lumitexel
