#include "processing/brdf/left_out_folds.h"

#include <algorithm>
#include <vector>

namespace lumitexel {
namespace {

std::vector<bool> views_with_samples(const Observations& observations, const LumitexelList& lumitexels) {
  std::vector<bool> seen;
  for (const std::size_t l : lumitexels) {
    for (std::size_t s = observations.first[l]; s < observations.first[l + 1]; ++s) {
      if (observations.view[s] >= seen.size()) seen.resize(observations.view[s] + std::size_t{1}, false);
      seen[observations.view[s]] = true;
    }
  }
  return seen;
}

void end_lumitexel(Observations& observations) { observations.first.push_back(observations.samples.size()); }

}  // namespace

std::size_t photographs_of(const Observations& observations, const LumitexelList& lumitexels) {
  if (observations.view.empty()) return 0;
  const std::vector<bool> seen = views_with_samples(observations, lumitexels);
  return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
}

PhotographFold photograph_fold(const Observations& observations, const LumitexelList& lumitexels, std::size_t fold, std::size_t folds) {
  const std::vector<bool> seen = views_with_samples(observations, lumitexels);
  std::vector<bool> left_out(seen.size(), false);
  std::size_t number = 0;
  for (std::size_t v = 0; v < seen.size(); ++v) {
    if (seen[v]) left_out[v] = number++ % folds == fold;
  }
  PhotographFold result;
  result.shown.channels = result.left_out.channels = observations.channels;
  for (const std::size_t l : lumitexels) {
    for (std::size_t s = observations.first[l]; s < observations.first[l + 1]; ++s) {
      Observations& side = left_out[observations.view[s]] ? result.left_out : result.shown;
      side.samples.push_back(observations.samples[s]);
      side.view.push_back(observations.view[s]);
    }
    end_lumitexel(result.shown);
    end_lumitexel(result.left_out);
  }
  return result;
}

}  // namespace lumitexel
