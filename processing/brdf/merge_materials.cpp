#include "processing/brdf/merge_materials.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "processing/brdf/choose_materials.h"
#include "processing/brdf/estimate_error.h"
#include "processing/brdf/misfit.h"
#include "processing/brdf/shared_brightness.h"

namespace lumitexel {
namespace {

constexpr int kRounds = 12;             // of settling after a merge
constexpr double kSettled = 1e-4;       // enough to tell which is next
constexpr int kTrialRounds = 3, kTrialSteps = 2;  // of a merged material's fit
constexpr std::size_t kMostTried = 8;   // pairs, the most alike first
constexpr std::size_t kMostTriedOnAll = 3, kLumitexelsForRanking = 1000;
constexpr std::size_t kMostGeometries = 500;

struct Pair {
  std::size_t first = 0, second = 0;
  double distance = 0;
};

struct Merge {
  Pair pair;
  MaterialModel merged;
  double loss = std::numeric_limits<double>::infinity();  // of log likelihood
  double samples = 0;   // of the pair
  double price = 0;     // in log likelihood, of keeping the two apart
};

double distance(const Brdf& a, const Brdf& b, const Observations& observations) {
  const std::size_t stride = observations.samples.size() / kMostGeometries + 1;
  double sum = 0.0;
  for (std::size_t s = 0; s < observations.samples.size(); s += stride) {
    const ChannelValues fa = predicted_reflectance(a, observations.samples[s].geometry);
    const ChannelValues fb = predicted_reflectance(b, observations.samples[s].geometry);
    for (std::size_t c = 0; c < static_cast<std::size_t>(a.channels); ++c) {
      sum += std::pow(std::sqrt(std::max(0.0, fa[c])) - std::sqrt(std::max(0.0, fb[c])), 2);
    }
  }
  return sum;
}

std::vector<Pair> likely_pairs(const Mixture& mixture, const Observations& observations) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < mixture.materials.size(); ++i) {
    for (std::size_t j = i + 1; j < mixture.materials.size(); ++j) {
      const double apart = distance(mixture.materials[i].brdf, mixture.materials[j].brdf, observations);
      pairs.push_back({i, j, apart * std::min(mixture.share[i], mixture.share[j])});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  if (pairs.size() > kMostTried) pairs.resize(kMostTried);
  return pairs;
}

// One lumitexel in `of`, scattered: materials may lie in the list in stripes that an even stride would fall in step with.
bool drawn(std::size_t lumitexel, std::size_t of) {
  return of <= 1 || ((lumitexel * 0x9E3779B97F4A7C15ull) >> 33) % of == 0;
}

// Of the lumitexels drawn, one in `of`.
std::vector<FitSample> samples_of_pair(const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                                       const Pair& pair, std::size_t of) {
  Responsibilities both{1, std::vector<double>(lumitexels.size()), {}, 0.0};
  for (std::size_t l = 0; l < lumitexels.size(); ++l) {
    if (drawn(l, of)) both.probability[l] = r.at(l, pair.first) + r.at(l, pair.second);
  }
  return samples_of(observations, lumitexels, both, 0);
}

// What keeping the two apart gains in log likelihood if all three shared the merged error model: of each lumitexel, ln of the two's
// mixture against the one.
double gain_in_appearance(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                          const Responsibilities& r, const Merge& merge, std::size_t of, double& samples) {
  const double shares = mixture.share[merge.pair.first] + mixture.share[merge.pair.second];
  double gain = 0.0;
  const PreparedMisfit merged(merge.merged.brdf, merge.merged.error);
  const PreparedMisfit first(mixture.materials[merge.pair.first].brdf, merge.merged.error);
  const PreparedMisfit second(mixture.materials[merge.pair.second].brdf, merge.merged.error);
  for (std::size_t l = 0; l < lumitexels.size(); ++l) {
    const double weight = r.at(l, merge.pair.first) + r.at(l, merge.pair.second);
    if (weight < 1e-3 || !drawn(l, of)) continue;
    const auto own = observations.of(lumitexels[l]);
    const double one = -0.5 * merged.of(own);
    const double a = std::log(mixture.share[merge.pair.first] / shares) - 0.5 * first.of(own);
    const double b = std::log(mixture.share[merge.pair.second] / shares) - 0.5 * second.of(own), most = std::max(a, b);
    gain += weight * (most + std::log(std::exp(a - most) + std::exp(b - most)) - one);
    samples += weight * static_cast<double>(own.size());
  }
  return gain;
}

Merge try_merge(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                const Pair& pair, std::size_t of, const MaterialFitOptions& options) {
  Merge merge;
  merge.pair = pair;
  const std::vector<FitSample> samples = samples_of_pair(observations, lumitexels, r, pair, of);
  const std::size_t larger = mixture.share[pair.first] >= mixture.share[pair.second] ? pair.first : pair.second;
  merge.merged = mixture.materials[larger];
  for (int round = 0; round < kTrialRounds; ++round) {
    BrdfFitOptions fit = refit_options(merge.merged, options);
    fit.reweightings = 1;
    fit.max_iterations = kTrialSteps;
    fit.brdf_alone = true;
    merge.merged.brdf = fit_brdf(merge.merged.brdf, samples, fit).brdf;
    if (options.estimate_error) merge.merged.error = updated_error_model(merge.merged.brdf, samples, merge.merged.error);
  }
  double count = 0.0;
  merge.loss = gain_in_appearance(mixture, observations, lumitexels, r, merge, of, count);
  if (options.estimate_error) merge.merged.error.independence = independence_of(merge.merged.brdf, samples, merge.merged.error);
  const int parameters = parameters_of(merge.merged.brdf, refit_options(merge.merged, options)).size() + 1;  // and its share
  const double independence = options.estimate_error ? merge.merged.error.independence : 1.0;
  merge.samples = count;
  merge.price = parameters * std::log(std::max(2.0, count * independence)) / (2.0 * independence);
  return merge;
}

// Each of the pairs merged, on one in `of` of the lumitexels.
std::vector<Merge> tried(std::span<const Pair> pairs, const Mixture& mixture, const Observations& observations,
                         const LumitexelList& lumitexels, const Responsibilities& r, std::size_t of, const MaterialFitOptions& options) {
  std::vector<Merge> merges(pairs.size());
  oneapi::tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t p) {
    merges[p] = try_merge(mixture, observations, lumitexels, r, pairs[p], of, options);
  });
  return merges;
}

bool needed_apart(const Merge& merge, const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                  const Responsibilities& r, const MaterialFitOptions& options) {
  const auto needed = [&](double gain) { return gain > merge.price && gain > kLeastGain * merge.samples; };
  if (!needed(merge.loss) || !options.estimate_error) return needed(merge.loss);
  const double first = mixture.share[merge.pair.first], second = mixture.share[merge.pair.second];
  const Mixture parts{{mixture.materials[merge.pair.first], mixture.materials[merge.pair.second]},
                      {first / (first + second), second / (first + second)}};
  std::vector<double> weight(lumitexels.size());
  for (std::size_t l = 0; l < weight.size(); ++l) weight[l] = r.at(l, merge.pair.first) + r.at(l, merge.pair.second);
  return needed(gain_beside_shared_brightness(merge.merged, parts, observations, lumitexels, weight));
}

// The cheapest of the pairs, tried on all lumitexels. Nothing if `only_where_not_needed` and the evidence is for keeping each apart.
std::optional<Merge> cheapest_of(std::span<const Pair> pairs, const Mixture& mixture, const Observations& observations,
                                 const LumitexelList& lumitexels, const Responsibilities& r, bool only_where_not_needed,
                                 const MaterialFitOptions& options) {
  std::vector<Merge> merges = tried(pairs, mixture, observations, lumitexels, r, 1, options);
  if (only_where_not_needed) {
    std::erase_if(merges, [&](const Merge& merge) { return needed_apart(merge, mixture, observations, lumitexels, r, options); });
  }
  if (merges.empty()) return std::nullopt;
  return *std::min_element(merges.begin(), merges.end(), [](const Merge& a, const Merge& b) { return a.loss < b.loss; });
}

// Nothing if `only_where_not_needed` and the evidence is for keeping every pair apart.
std::optional<Merge> cheapest_merge(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                    const Responsibilities& r, bool only_where_not_needed, const MaterialFitOptions& options) {
  std::vector<Pair> pairs = likely_pairs(mixture, observations);
  const std::size_t of = lumitexels.size() / kLumitexelsForRanking + 1;
  std::size_t first = pairs.size();
  if (of > 1) {  // a part of the lumitexels tells which few are worth all of them
    std::vector<Merge> ranking = tried(pairs, mixture, observations, lumitexels, r, of, options);
    std::stable_sort(ranking.begin(), ranking.end(), [](const Merge& a, const Merge& b) { return a.loss < b.loss; });
    std::transform(ranking.begin(), ranking.end(), pairs.begin(), [](const Merge& merge) { return merge.pair; });
    first = std::min(kMostTriedOnAll, pairs.size());
  }
  const std::span<const Pair> all(pairs);
  const auto cheapest = cheapest_of(all.first(first), mixture, observations, lumitexels, r, only_where_not_needed, options);
  if (cheapest) return cheapest;
  // A pair that costs much may still be one material in many shades: nothing ends before each has been asked.
  return cheapest_of(all.subspan(first), mixture, observations, lumitexels, r, only_where_not_needed, options);
}

void apply(const Merge& merge, Mixture& mixture) {
  mixture.materials[merge.pair.first] = merge.merged;
  mixture.share[merge.pair.first] += mixture.share[merge.pair.second];
  mixture.materials.erase(mixture.materials.begin() + static_cast<std::ptrdiff_t>(merge.pair.second));
  mixture.share.erase(mixture.share.begin() + static_cast<std::ptrdiff_t>(merge.pair.second));
}

int size_of(const Mixture& mixture) { return static_cast<int>(mixture.materials.size()); }

void merge_until(int materials, bool stop_where_needed, Mixture& mixture, const Observations& observations,
                 const LumitexelList& lumitexels, const MaterialFitOptions& fit, const std::function<void(const Mixture&)>& after) {
  Responsibilities r = responsibilities(mixture, observations, lumitexels);
  while (size_of(mixture) > std::max(1, materials)) {
    const std::optional<Merge> merge = cheapest_merge(mixture, observations, lumitexels, r, stop_where_needed, fit);
    if (!merge) break;
    apply(*merge, mixture);
    r = maximise_expectation(mixture, observations, lumitexels, fit, {kRounds, kSettled, false});
    after(mixture);
  }
}

}  // namespace

std::vector<Choice> merge_materials(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                    const MergeOptions& options, const std::function<void(int)>& report) {
  const bool automatic = options.materials == 0;
  const auto after_merge = [&](const Mixture& merged) { report(size_of(merged) + (automatic ? kChoosingSteps : 0)); };
  if (!automatic || options.fit.estimate_error) {
    merge_until(options.materials, automatic, mixture, observations, lumitexels, options.fit, after_merge);
  }
  if (!automatic) return {};
  std::vector<Mixture> candidates{mixture};
  merge_until(1, false, mixture, observations, lumitexels, options.fit, [&](const Mixture& merged) {
    candidates.push_back(merged);
    after_merge(merged);
  });
  const Presumed presumed = options.fit.estimate_error ? Presumed::Many : Presumed::Few;
  const ChosenMaterials chosen = choose_materials(candidates, presumed, observations, lumitexels, options.judges.empty() ? lumitexels : options.judges, options.fit,
                                                  [&](int left) { report(1 + left); });
  mixture = candidates[chosen.candidate];
  return chosen.choices;
}

}  // namespace lumitexel
