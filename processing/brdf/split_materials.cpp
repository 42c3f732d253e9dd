#include "processing/brdf/split_materials.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "processing/brdf/split_directions.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostSamples = 8000;  // that a split is tried on
constexpr int kRounds = 5;
constexpr double kSettled = 1e-4;
constexpr std::size_t kWorstShare = 8;  // one in so many, the worst explained, may begin a material of their own

struct Part {  // a material and the lumitexels that are most probably its own
  MaterialModel model;
  LumitexelList members;
};

struct Split {
  Part first, second;
  double gain = 0;  // of log likelihood, over all members
};

std::size_t count_samples(const Observations& observations, const LumitexelList& lumitexels) {
  std::size_t count = 0;
  for (const std::size_t i : lumitexels) count += observations.of(i).size();
  return count;
}

// r: of the material alone.
Brdf fit_of_worst(const MaterialModel& model, const Observations& observations, const LumitexelList& members,
                  const Responsibilities& r, const MaterialFitOptions& options) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t l = 0; l < members.size(); ++l) {
    const double samples = std::max<double>(1.0, static_cast<double>(observations.of(members[l]).size()));
    ranked.emplace_back(-r.misfit_at(l, 0) / samples, members[l]);
  }
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(std::max<std::size_t>(static_cast<std::size_t>(kFewestMembers), ranked.size() / kWorstShare));
  LumitexelList worst;
  for (const auto& entry : ranked) worst.push_back(entry.second);
  std::sort(worst.begin(), worst.end());
  return fit_brdf(model.brdf, samples_of(observations, worst), refit_options(model, options)).brdf;
}

std::vector<BrdfPair> proposals(const MaterialModel& model, const Observations& observations, const LumitexelList& members,
                                const Responsibilities& alone, const MaterialFitOptions& options) {
  const auto samples = samples_of(observations, members);
  const BrdfFitOptions refit = refit_options(model, options);
  const BrdfFit fit = fit_brdf(model.brdf, samples, refit);
  return {split_along_covariance(fit.brdf, fit.covariance, parameters_of(fit.brdf, refit)),
          split_along_brightness(model.brdf, observations, members, model.error),
          {model.brdf, fit_of_worst(model, observations, members, alone, options)}};
}

void share_out(const LumitexelList& members, const Responsibilities& r, Split& split) {
  for (std::size_t l = 0; l < members.size(); ++l) {
    (r.at(l, 0) >= r.at(l, 1) ? split.first : split.second).members.push_back(members[l]);
  }
}

std::optional<Split> best_split(const Part& part, const Observations& observations, const MaterialFitOptions& options) {
  if (part.members.empty()) return std::nullopt;
  const std::size_t samples = count_samples(observations, part.members);
  const std::size_t most = part.members.size() * kMostSamples / std::max(samples, kMostSamples);
  const LumitexelList members = thinned(part.members, most);
  if (static_cast<double>(members.size()) < 2.0 * kFewestMembers) return std::nullopt;
  const Responsibilities alone = responsibilities({{part.model}, {1.0}}, observations, members);
  std::optional<Split> best;
  for (const BrdfPair& pair : proposals(part.model, observations, members, alone, options)) {
    Mixture halves{{{pair.first, part.model.error}, {pair.second, part.model.error}}, {0.5, 0.5}};
    // Tails are asked for anew: what the whole took for outliers may be the smaller half.
    const Responsibilities r = maximise_expectation(halves, observations, members, options, {kRounds, kSettled, true});
    const double gain = (r.log_likelihood - alone.log_likelihood) * static_cast<double>(part.members.size()) /
                        static_cast<double>(members.size());
    if (halves.materials.size() < 2 || (best && gain <= best->gain) || gain <= 0.0) continue;
    Split split{{halves.materials[0], {}}, {halves.materials[1], {}}, gain};
    share_out(part.members, responsibilities(halves, observations, part.members), split);
    const std::size_t fewest = std::min(split.first.members.size(), split.second.members.size());
    if (static_cast<double>(fewest) >= 0.5 * kFewestMembers) best = std::move(split);
  }
  return best;
}

Mixture mixture_of(const std::vector<Part>& parts) {
  Mixture mixture;
  double all = 0.0;
  for (const Part& part : parts) all += static_cast<double>(part.members.size());
  for (const Part& part : parts) {
    mixture.materials.push_back(part.model);
    mixture.share.push_back(static_cast<double>(part.members.size()) / all);
  }
  return mixture;
}

}  // namespace

Mixture split_materials(const MaterialFit& whole, const Observations& observations, const LumitexelList& lumitexels, int most,
                        const MaterialFitOptions& options, const std::function<void(int)>& report) {
  std::vector<Part> parts{{whole.model, lumitexels}};
  std::vector<std::optional<Split>> splits{best_split(parts[0], observations, options)};
  while (static_cast<int>(parts.size()) < most) {
    std::size_t chosen = parts.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (splits[i] && (chosen == parts.size() || splits[i]->gain > splits[chosen]->gain)) chosen = i;
    }
    if (chosen == parts.size()) break;
    const Split split = *splits[chosen];
    parts[chosen] = split.first;
    parts.push_back(split.second);
    report(static_cast<int>(parts.size()));
    if (static_cast<int>(parts.size()) == most) break;
    splits[chosen] = best_split(parts[chosen], observations, options);
    splits.push_back(best_split(parts.back(), observations, options));
  }
  return mixture_of(parts);
}

}  // namespace lumitexel
