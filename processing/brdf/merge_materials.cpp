#include "processing/brdf/merge_materials.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "processing/brdf/estimate_error.h"
#include "processing/brdf/left_out_error.h"
#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

constexpr int kRounds = 12;             // of settling after a merge
constexpr std::size_t kMostTried = 8;   // pairs, the most alike first
constexpr std::size_t kMostGeometries = 500;

struct Pair {
  std::size_t first = 0, second = 0;
  double distance = 0;
};

struct Merge {
  Pair pair;
  MaterialModel merged;
  double loss = std::numeric_limits<double>::infinity();  // of log likelihood
  bool needed_apart = true;
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

std::vector<FitSample> samples_of_pair(const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                                       const Pair& pair) {
  Responsibilities both{1, std::vector<double>(lumitexels.size()), {}, 0.0};
  for (std::size_t l = 0; l < lumitexels.size(); ++l) both.probability[l] = r.at(l, pair.first) + r.at(l, pair.second);
  return samples_of(observations, lumitexels, both, 0);
}

// What keeping the two apart gains in log likelihood if all three shared the merged error model: of each lumitexel, ln of the two's
// mixture against the one.
double gain_in_appearance(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                          const Responsibilities& r, const Merge& merge, double& samples) {
  const double shares = mixture.share[merge.pair.first] + mixture.share[merge.pair.second];
  double gain = 0.0;
  for (std::size_t l = 0; l < lumitexels.size(); ++l) {
    const double weight = r.at(l, merge.pair.first) + r.at(l, merge.pair.second);
    if (weight < 1e-3) continue;
    const auto own = observations.of(lumitexels[l]);
    const double one = -0.5 * misfit(merge.merged.brdf, own, merge.merged.error);
    const auto part = [&](std::size_t k) {
      return std::log(mixture.share[k] / shares) - 0.5 * misfit(mixture.materials[k].brdf, own, merge.merged.error);
    };
    const double a = part(merge.pair.first), b = part(merge.pair.second), most = std::max(a, b);
    gain += weight * (most + std::log(std::exp(a - most) + std::exp(b - most)) - one);
    samples += weight * static_cast<double>(own.size());
  }
  return gain;
}

Merge try_merge(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels, const Responsibilities& r,
                const Pair& pair, const MaterialFitOptions& options) {
  Merge merge;
  merge.pair = pair;
  const std::vector<FitSample> samples = samples_of_pair(observations, lumitexels, r, pair);
  const std::size_t larger = mixture.share[pair.first] >= mixture.share[pair.second] ? pair.first : pair.second;
  merge.merged = mixture.materials[larger];
  for (int round = 0; round < 2; ++round) {
    merge.merged.brdf = fit_brdf(merge.merged.brdf, samples, refit_options(merge.merged, options)).brdf;
    if (options.estimate_error) merge.merged.error = estimate_error_model(merge.merged.brdf, samples, merge.merged.error);
  }
  double count = 0.0;
  merge.loss = gain_in_appearance(mixture, observations, lumitexels, r, merge, count);
  const int parameters = parameters_of(merge.merged.brdf, refit_options(merge.merged, options)).size() + 1;  // and its share
  const double independence = options.estimate_error ? merge.merged.error.independence : 1.0;
  merge.needed_apart = 2.0 * independence * merge.loss > parameters * std::log(std::max(2.0, count * independence)) &&
                       merge.loss > kLeastGain * count;
  return merge;
}

// Nothing if `only_where_not_needed` and the evidence is for keeping every pair apart.
std::optional<Merge> cheapest_merge(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                    const Responsibilities& r, bool only_where_not_needed, const MaterialFitOptions& options) {
  const std::vector<Pair> pairs = likely_pairs(mixture, observations);
  std::vector<Merge> merges(pairs.size());
  oneapi::tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t p) {
    merges[p] = try_merge(mixture, observations, lumitexels, r, pairs[p], options);
  });
  if (only_where_not_needed) std::erase_if(merges, [](const Merge& merge) { return merge.needed_apart; });
  if (merges.empty()) return std::nullopt;
  return *std::min_element(merges.begin(), merges.end(), [](const Merge& a, const Merge& b) { return a.loss < b.loss; });
}

void apply(const Merge& merge, Mixture& mixture) {
  mixture.materials[merge.pair.first] = merge.merged;
  mixture.share[merge.pair.first] += mixture.share[merge.pair.second];
  mixture.materials.erase(mixture.materials.begin() + static_cast<std::ptrdiff_t>(merge.pair.second));
  mixture.share.erase(mixture.share.begin() + static_cast<std::ptrdiff_t>(merge.pair.second));
}

// A stage of merging, and what left-out samples say of it, per lumitexel.
struct Candidate {
  Mixture mixture;
  std::vector<SquaredError> errors;
};

// candidates: from many materials to one.
std::size_t fewest_that_predict(const std::vector<Candidate>& candidates) {
  const SquaredError scale = total_error(candidates.back().errors);
  std::vector<std::vector<double>> errors;
  std::size_t best = 0;
  std::vector<double> totals;
  for (const Candidate& candidate : candidates) {
    errors.push_back(relative_errors(candidate.errors, scale));
    totals.push_back(std::accumulate(errors.back().begin(), errors.back().end(), 0.0));
    if (totals.back() < totals[best]) best = totals.size() - 1;
  }
  for (std::size_t i = candidates.size(); i-- > best;) {
    if (excess_in_standard_errors(errors[i], errors[best]) <= kStandardErrors) return i;
  }
  return best;
}

void merge_until(int materials, bool stop_where_needed, Mixture& mixture, const Observations& observations,
                 const LumitexelList& lumitexels, const MaterialFitOptions& fit, const std::function<void(int)>& after) {
  Responsibilities r = responsibilities(mixture, observations, lumitexels);
  while (static_cast<int>(mixture.materials.size()) > std::max(1, materials)) {
    const std::optional<Merge> merge = cheapest_merge(mixture, observations, lumitexels, r, stop_where_needed, fit);
    if (!merge) break;
    apply(*merge, mixture);
    r = maximise_expectation(mixture, observations, lumitexels, fit, kRounds);
    after(static_cast<int>(mixture.materials.size()));
  }
}

}  // namespace

Responsibilities merge_materials(Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                                 const MergeOptions& options, const std::function<void(int)>& report) {
  const bool chosen = options.materials == 0;
  if (chosen && !options.fit.estimate_error) {
    const double clip = clip_level(observations, lumitexels);
    std::vector<Candidate> candidates{{mixture, left_out_errors(mixture, observations, lumitexels, clip)}};
    merge_until(1, false, mixture, observations, lumitexels, options.fit, [&](int left) {
      candidates.push_back({mixture, left_out_errors(mixture, observations, lumitexels, clip)});
      report(left);
    });
    mixture = candidates[fewest_that_predict(candidates)].mixture;
  } else {
    merge_until(options.materials, chosen, mixture, observations, lumitexels, options.fit, report);
  }
  return responsibilities(mixture, observations, lumitexels);
}

}  // namespace lumitexel
