#include "processing/brdf/cluster_materials.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "processing/brdf/merge_materials.h"
#include "processing/brdf/split_materials.h"

namespace lumitexel {
namespace {

constexpr int kFinalRounds = 4;
constexpr int kMostExtra = 8;  // materials beyond those wanted that splitting may make

LumitexelList with_samples(const Observations& observations) {
  LumitexelList some;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    if (!observations.of(i).empty()) some.push_back(i);
  }
  return some;
}

LumitexelList thinned(const LumitexelList& list, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, (list.size() + most - 1) / std::max<std::size_t>(1, most));
  LumitexelList some;
  for (std::size_t k = 0; k < list.size(); k += stride) some.push_back(list[k]);
  return some;
}

std::vector<int> most_probable(const Responsibilities& r) {
  std::vector<int> label(r.lumitexels());
  for (std::size_t l = 0; l < label.size(); ++l) {
    const double* begin = &r.probability[l * r.materials];
    label[l] = static_cast<int>(std::max_element(begin, begin + r.materials) - begin);
  }
  return label;
}

// About `most` members of each material, of those in `all`.
LumitexelList members_of_all(const std::vector<int>& label, const LumitexelList& all, std::size_t materials, std::size_t most) {
  std::vector<LumitexelList> members(materials);
  for (std::size_t l = 0; l < all.size(); ++l) members[static_cast<std::size_t>(label[l])].push_back(all[l]);
  LumitexelList chosen;
  for (const LumitexelList& own : members) {
    const LumitexelList some = thinned(own, most);
    chosen.insert(chosen.end(), some.begin(), some.end());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// Each material's lobes, asked for anew: while splitting and merging all had those of the whole.
void choose_lobes(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                  const MaterialFitOptions& options, std::vector<BrdfFit>& fits) {
  fits.resize(mixture.materials.size());
  oneapi::tbb::parallel_for(std::size_t{0}, mixture.materials.size(), [&](std::size_t k) {
    MaterialFitOptions own = options;
    own.error = mixture.materials[k].error;
    const auto samples = samples_of(observations, lumitexels, r, k);
    const MaterialFit fit = fit_material(samples, observations.channels, &mixture.materials[k].brdf, own);
    mixture.materials[k] = fit.model;
    fits[k] = fit.fit;
  });
}

void label_everything(const Mixture& mixture, const Observations& observations, const LumitexelList& all,
                      const std::vector<BrdfFit>& fits, Clustering& result) {
  const std::vector<int> label = most_probable(responsibilities(mixture, observations, all));
  for (std::size_t k = 0; k < mixture.materials.size(); ++k) result.materials.push_back({mixture.materials[k], fits[k], 0});
  for (const int material : label) ++result.materials[static_cast<std::size_t>(material)].members;
  const auto largest = std::max_element(result.materials.begin(), result.materials.end(),
                                        [](const auto& a, const auto& b) { return a.members < b.members; });
  result.label.assign(observations.lumitexels(), static_cast<int>(largest - result.materials.begin()));
  for (std::size_t l = 0; l < all.size(); ++l) result.label[all[l]] = label[l];
}

}  // namespace

Clustering cluster_materials(const Observations& observations, const LumitexelList& selection, const ClusterOptions& options,
                             const std::function<void(int)>& report) {
  Clustering result;
  const int wanted = options.materials > 0 ? options.materials : kMostMaterials;
  const int most = wanted == 1 ? 1 : std::min(2 * wanted, wanted + kMostExtra);
  const MaterialFit whole = fit_material(samples_of(observations, selection), observations.channels, nullptr, options.fit);
  report(1);

  // While materials are told apart they all have a lobe: what a matte whole hides, a part may show.
  MaterialFitOptions searching = options.fit;
  searching.choose_lobes = false;
  searching.most_lobes = std::min(1, options.fit.most_lobes);
  const MaterialFit start = most == 1 ? whole : fit_material(samples_of(observations, selection), observations.channels, nullptr, searching);
  Mixture mixture = split_materials(start, observations, selection, most, searching);
  Responsibilities r = merge_materials(mixture, observations, selection, {options.materials, searching}, report);

  std::vector<BrdfFit> fits;
  choose_lobes(mixture, observations, selection, r, options.fit, fits);
  const LumitexelList all = with_samples(observations);
  const std::vector<int> label = most_probable(responsibilities(mixture, observations, all));
  const LumitexelList finalists = members_of_all(label, all, mixture.materials.size(), options.final_lumitexels);
  r = maximise_expectation(mixture, observations, finalists, options.fit, kFinalRounds);
  choose_lobes(mixture, observations, finalists, r, options.fit, fits);
  result.single = fit_material(samples_of(observations, thinned(all, options.final_lumitexels)), observations.channels, &whole.model.brdf,
                               options.fit).model;
  label_everything(mixture, observations, all, fits, result);
  return result;
}

}  // namespace lumitexel
