#include "processing/brdf/cluster_materials.h"

#include <algorithm>

#include "processing/brdf/choose_noise_shape.h"
#include "processing/brdf/material_search.h"

namespace lumitexel {
namespace {

// Of log likelihood a sample and round. What is left after the last round is a multiple of its change, and should be small beside one in all.
constexpr double kFinalSettled = 1e-6;
constexpr int kFinalRounds = 40;  // of expectation-maximisation
constexpr int kFinalSteps = 4;    // that are reported: which lobes, settled, lobes anew, labels

std::vector<int> most_probable(const Responsibilities& r) {
  std::vector<int> label(r.lumitexels());
  for (std::size_t l = 0; l < label.size(); ++l) {
    const double* begin = &r.probability[l * r.materials];
    label[l] = static_cast<int>(std::max_element(begin, begin + r.materials) - begin);
  }
  return label;
}

// About `most` members of each material, of those in `all`.
LumitexelList members_of_all(const std::vector<int>& label, const LumitexelList& all, std::size_t materials, std::size_t most, int draw) {
  std::vector<LumitexelList> members(materials);
  for (std::size_t l = 0; l < all.size(); ++l) members[static_cast<std::size_t>(label[l])].push_back(all[l]);
  LumitexelList chosen;
  for (const LumitexelList& own : members) {
    const LumitexelList some = thinned(own, most, draw);
    chosen.insert(chosen.end(), some.begin(), some.end());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void set_shares(const Responsibilities& r, Mixture& mixture) {
  std::fill(mixture.share.begin(), mixture.share.end(), 0.0);
  for (std::size_t l = 0; l < r.lumitexels(); ++l) {
    for (std::size_t k = 0; k < r.materials; ++k) mixture.share[k] += r.at(l, k) / static_cast<double>(r.lumitexels());
  }
  for (double& share : mixture.share) share = std::max(share, 1e-300);  // its logarithm is taken
}

// Where errors end abruptly, lumitexels are told apart by that, and the materials settle anew.
void settle_with_edges(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const MaterialFitOptions& fit,
                       Responsibilities& r) {
  mixture.noise = choose_noise_shape(mixture, observations, lumitexels, r);
  if (mixture.noise.normal()) return;
  r = maximise_expectation(mixture, observations, lumitexels, fit, {kFinalRounds, kFinalSettled, false});
}

}  // namespace

const char* to_string(ErrorSource source) {
  switch (source) {
    case ErrorSource::Given: return "given";
    case ErrorSource::Labels: return "labels";
    case ErrorSource::Estimated: return "estimated";
    case ErrorSource::Auto: break;
  }
  return "auto";
}

const char* to_string(LobeShapes shapes) {
  switch (shapes) {
    case LobeShapes::Shared: return "shared";
    case LobeShapes::Separate: return "separate";
    case LobeShapes::Auto: break;
  }
  return "auto";
}

void set_labels(const std::vector<int>& label, const LumitexelList& all, std::size_t lumitexels, Clustering& clustering) {
  for (const int material : label) ++clustering.materials[static_cast<std::size_t>(material)].members;
  const auto largest = std::max_element(clustering.materials.begin(), clustering.materials.end(),
                                        [](const auto& a, const auto& b) { return a.members < b.members; });
  clustering.label.assign(lumitexels, static_cast<int>(largest - clustering.materials.begin()));
  for (std::size_t l = 0; l < all.size(); ++l) clustering.label[all[l]] = label[l];
}

Clustering cluster_materials(const Observations& observations, const LumitexelList& selection, const ClusterOptions& options,
                             const std::function<void(int)>& report) {
  Clustering result;
  const int steps = clustering_steps(options) - kFinalSteps;
  report(0);
  MaterialSearch search = search_for_materials(observations, selection, options, report);
  Mixture& mixture = search.mixture;
  Responsibilities r = responsibilities(mixture, observations, selection);

  MaterialFitOptions settled = options.fit;
  settled.estimate_error = search.fit.estimate_error;
  settled.mean_fit = search.fit.mean_fit;
  settled.family = search.fit.family;
  settled.shared_shape = search.fit.shared_shape;
  result.errors = search.errors;
  result.choices = std::move(search.choices);
  result.fit = settled;
  std::vector<BrdfFit> fits;
  // The search went with one lobe each: more come in here, so that the mixture settles with them.
  if (settled.most_lobes > search.fit.most_lobes) choose_lobes(mixture, observations, selection, r, settled, fits);
  report(steps + 1);
  const LumitexelList all = with_samples(observations);
  const std::vector<int> label = most_probable(responsibilities(mixture, observations, all));
  const LumitexelList finalists = members_of_all(label, all, mixture.materials.size(), options.final_lumitexels, options.draw);
  r = maximise_expectation(mixture, observations, finalists, settled, {kFinalRounds, kFinalSettled});
  if (settled.estimate_error) settle_with_edges(mixture, observations, finalists, settled, r);
  report(steps + 2);
  choose_lobes(mixture, observations, finalists, r, settled, fits);
  report(steps + 3);
  // With their lobes the materials' scales and tails changed.
  if (!mixture.noise.normal()) mixture.noise = choose_noise_shape(mixture, observations, finalists, r);
  // What all is measured against: the best mean prediction, whatever the materials were fitted by.
  MaterialFitOptions mean = settled;
  mean.mean_fit.reset();
  mean.estimate_error = false;
  const Brdf start = fit_material(samples_of(observations, selection), observations.channels, nullptr, mean).model.brdf;
  result.single = fit_material(samples_of(observations, thinned(all, options.final_lumitexels, options.draw)), observations.channels, &start, mean).model;
  for (std::size_t k = 0; k < mixture.materials.size(); ++k) {
    result.materials.push_back({mixture.materials[k], fits[k], 0, sigma_of(mixture.materials[k], samples_of(observations, finalists, r, k), settled)});
  }
  // The finalists were chosen alike from every material: how common each is, all lumitexels say.
  set_shares(responsibilities(mixture, observations, all), mixture);
  set_labels(most_probable(responsibilities(mixture, observations, all)), all, observations.lumitexels(), result);
  report(steps + kFinalSteps);
  return result;
}

int clustering_steps(const ClusterOptions& options) { return search_steps(options) + kFinalSteps; }

}  // namespace lumitexel
