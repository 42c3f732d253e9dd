#include "processing/brdf/cluster_materials.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "processing/brdf/misfit.h"
#include "processing/brdf/split_directions.h"

namespace lumitexel {
namespace {

constexpr int kSplitRounds = 6;
constexpr int kGlobalRounds = 12;
constexpr double kSettled = 0.002;           // share of labels that may still move when reclustering ends
constexpr std::size_t kFewestMembers = 20;   // a material needs as many lumitexels
constexpr std::size_t kWorstShare = 8;       // one in so many, the worst explained, may begin a material of their own

using Members = std::vector<std::size_t>;

struct Split {
  LafortuneBrdf first, second;
  double gain = 0;  // of minus twice the log likelihood
};

class Clusterer {
 public:
  Clusterer(const Observations& observations, const ClusterOptions& options)
      : observations_(observations), options_(options) {}

  FittedMaterial fit(const Members& members, const LafortuneBrdf* start) const {
    std::vector<const Observation*> samples;
    for (const std::size_t i : members) {
      for (const Observation& sample : observations_.of(i)) samples.push_back(&sample);
    }
    const LobeFit fit = fit_one_lobe(samples, observations_.channels, start, options_.fit);
    return {fit.brdf, fit.covariance, members.size()};
  }

  // Index of the BRDF that explains each of `lumitexels` best, and how badly it does.
  void assign(const std::vector<LafortuneBrdf>& brdfs, const Members& lumitexels, std::vector<int>& label,
              std::vector<double>& cost) const {
    label.assign(lumitexels.size(), 0);
    cost.assign(lumitexels.size(), 0.0);
    oneapi::tbb::parallel_for(std::size_t{0}, lumitexels.size(), [&](std::size_t k) {
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < brdfs.size(); ++j) {
        const double value = misfit(brdfs[j], observations_.of(lumitexels[k]), options_.fit.error);
        if (value >= best) continue;
        best = value;
        label[k] = static_cast<int>(j);
      }
      cost[k] = std::isfinite(best) ? best : 0.0;
    });
  }

  // Assigns and refits in turn until the labels settle; returns the final cost. Materials that lose their members vanish.
  double recluster(std::vector<FittedMaterial>& materials, const Members& lumitexels, std::vector<int>& label, int rounds,
                   int& rounds_used) const {
    std::vector<double> cost;
    std::vector<int> before;
    for (int round = 0; round < rounds; ++round) {
      assign(brdfs_of(materials), lumitexels, label, cost);
      ++rounds_used;
      if (round > 0 && moved(before, label) <= kSettled * static_cast<double>(label.size())) break;
      before = label;
      if (refit(materials, lumitexels, label)) before.clear();
    }
    assign(brdfs_of(materials), lumitexels, label, cost);
    return std::accumulate(cost.begin(), cost.end(), 0.0);
  }

  // cost: of each member under the material as it is.
  LafortuneBrdf fit_of_worst(const Members& members, const std::vector<double>& cost) const {
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const double samples = std::max<double>(1.0, static_cast<double>(observations_.of(members[k]).size()));
      ranked.emplace_back(-cost[k] / samples, members[k]);
    }
    std::sort(ranked.begin(), ranked.end());
    ranked.resize(std::max(kFewestMembers, ranked.size() / kWorstShare));
    Members worst;
    for (const auto& [negative_cost, lumitexel] : ranked) worst.push_back(lumitexel);
    return fit(worst, nullptr).brdf;
  }

  Split best_split(const FittedMaterial& material, const Members& members) const {
    Split best;
    if (members.size() < 2 * kFewestMembers) return best;
    std::vector<int> label;
    std::vector<double> cost;
    assign({material.brdf}, members, label, cost);
    const double whole = std::accumulate(cost.begin(), cost.end(), 0.0);
    for (const BrdfPair& pair : {split_along_covariance(material, options_.fit.shared_shape),
                                 split_along_brightness(material, observations_, members, options_.fit.error),
                                 BrdfPair{material.brdf, fit_of_worst(members, cost)}}) {
      std::vector<FittedMaterial> halves{{pair.first, {}, 0}, {pair.second, {}, 0}};
      int rounds = 0;
      const double parted = recluster(halves, members, label, kSplitRounds, rounds);
      if (halves.size() == 2 && whole - parted > best.gain) best = {halves[0].brdf, halves[1].brdf, whole - parted};
    }
    return best;
  }

  static std::vector<LafortuneBrdf> brdfs_of(const std::vector<FittedMaterial>& materials) {
    std::vector<LafortuneBrdf> brdfs;
    for (const FittedMaterial& material : materials) brdfs.push_back(material.brdf);
    return brdfs;
  }

  static std::vector<Members> members_of(std::size_t materials, const Members& lumitexels, const std::vector<int>& label) {
    std::vector<Members> members(materials);
    for (std::size_t k = 0; k < lumitexels.size(); ++k) members[static_cast<std::size_t>(label[k])].push_back(lumitexels[k]);
    return members;
  }

 private:
  static double moved(const std::vector<int>& before, const std::vector<int>& after) {
    if (before.size() != after.size()) return static_cast<double>(after.size());
    double count = 0.0;
    for (std::size_t k = 0; k < after.size(); ++k) count += before[k] != after[k];
    return count;
  }

  // True if a material vanished, which shifts the labels.
  bool refit(std::vector<FittedMaterial>& materials, const Members& lumitexels, const std::vector<int>& label) const {
    const std::vector<Members> members = members_of(materials.size(), lumitexels, label);
    std::vector<FittedMaterial> kept(materials.size());
    oneapi::tbb::parallel_for(std::size_t{0}, materials.size(), [&](std::size_t j) {
      if (members[j].size() >= kFewestMembers) kept[j] = fit(members[j], &materials[j].brdf);
    });
    std::erase_if(kept, [](const FittedMaterial& material) { return material.members == 0; });
    if (kept.empty()) return false;
    const bool vanished = kept.size() != materials.size();
    materials = std::move(kept);
    return vanished;
  }

  const Observations& observations_;
  const ClusterOptions& options_;
};

// Splits once where it gains most; false if no split gains.
bool split_once(const Clusterer& clusterer, std::vector<FittedMaterial>& materials, const Members& selection,
                const std::vector<int>& label) {
  const std::vector<Members> members = Clusterer::members_of(materials.size(), selection, label);
  std::size_t chosen = 0;
  Split best;
  for (std::size_t j = 0; j < materials.size(); ++j) {
    const Split split = clusterer.best_split(materials[j], members[j]);
    if (split.gain <= best.gain) continue;
    best = split;
    chosen = j;
  }
  if (best.gain <= 0.0) return false;
  materials[chosen].brdf = best.first;
  materials.push_back({best.second, {}, 0});
  return true;
}

Members with_samples(const Observations& observations) {
  Members some;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    if (!observations.of(i).empty()) some.push_back(i);
  }
  return some;
}

int largest(const std::vector<FittedMaterial>& materials) {
  std::size_t best = 0;
  for (std::size_t j = 1; j < materials.size(); ++j) {
    if (materials[j].members > materials[best].members) best = j;
  }
  return static_cast<int>(best);
}

Members thinned(const Members& members, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, (members.size() + most / 2) / most);
  Members some;
  for (std::size_t k = 0; k < members.size(); k += stride) some.push_back(members[k]);
  return some;
}

// From the selection to every lumitexel with samples: labels them, refits each material on many of its members, labels again.
void label_all(const Clusterer& clusterer, const Observations& observations, std::size_t most,
               std::vector<FittedMaterial>& materials, Clustering& result) {
  const Members all = with_samples(observations);
  std::vector<int> label;
  std::vector<double> cost;
  clusterer.assign(Clusterer::brdfs_of(materials), all, label, cost);
  const std::vector<Members> members = Clusterer::members_of(materials.size(), all, label);
  for (std::size_t j = 0; j < materials.size(); ++j) {
    if (members[j].size() >= kFewestMembers) materials[j] = clusterer.fit(thinned(members[j], most), &materials[j].brdf);
  }
  clusterer.assign(Clusterer::brdfs_of(materials), all, label, cost);
  result.single = clusterer.fit(thinned(all, most), &result.single).brdf;
  for (FittedMaterial& material : materials) material.members = 0;
  for (const int material : label) ++materials[static_cast<std::size_t>(material)].members;
  result.label.assign(observations.lumitexels(), largest(materials));
  for (std::size_t k = 0; k < all.size(); ++k) result.label[all[k]] = label[k];
}

}  // namespace

Clustering cluster_materials(const Observations& observations, const std::vector<std::size_t>& selection,
                             const ClusterOptions& options, const std::function<void(int)>& report) {
  const Clusterer clusterer(observations, options);
  Clustering result;
  std::vector<FittedMaterial> materials{clusterer.fit(selection, nullptr)};
  result.single = materials[0].brdf;
  std::vector<int> label(selection.size(), 0);
  report(1);
  while (static_cast<int>(materials.size()) < options.materials) {
    const std::size_t before = materials.size();
    if (!split_once(clusterer, materials, selection, label)) break;
    clusterer.recluster(materials, selection, label, kGlobalRounds, result.recluster_rounds);
    report(static_cast<int>(materials.size()));
    if (materials.size() <= before) break;  // the new material did not survive
  }
  label_all(clusterer, observations, options.final_lumitexels, materials, result);
  result.materials = std::move(materials);
  return result;
}

}  // namespace lumitexel
