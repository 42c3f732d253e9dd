#include "processing/brdf/experiment/experiment_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lumitexel {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double median(std::vector<double> values) {
  if (values.empty()) return kNothing;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return kNothing;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::vector<ExperimentRow> experiment_settings() {
  std::vector<ExperimentRow> rows;
  const auto add = [&](const char* name, bool even, bool gaussian, double outliers) {
    FiveMaterialsOptions options;
    options.even = even;
    options.gaussian = gaussian;
    options.outliers = outliers;
    rows.push_back({name, options, {}});
  };
  add("even, uniform noise", true, false, 0.0);
  add("even, Gaussian noise", true, true, 0.0);
  add("even, uniform, 2 % outliers", true, false, 0.02);
  add("uneven, uniform noise", false, false, 0.0);
  add("uneven, Gaussian noise", false, true, 0.0);
  add("uneven, uniform, 2 % outliers", false, false, 0.02);
  return rows;
}

ExperimentTally tally(const ExperimentRow& row) {
  ExperimentTally sum;
  std::vector<double> worst_exponent, worst_diffuse, exponent, diffuse, exponent_unlabelled, diffuse_unlabelled, bayes, normal;
  for (const FiveMaterialsScore& s : row.scores) {
    ++sum.seeds;
    sum.five += s.found == 5;
    sum.found += s.all_found;
    if (!s.all_found) continue;
    sum.under_paper += s.worst_exponent < kPaperError && s.worst_diffuse < kPaperError;
    worst_exponent.push_back(s.worst_exponent);
    worst_diffuse.push_back(s.worst_diffuse);
    exponent.push_back(s.squared_exponent);
    diffuse.push_back(s.squared_diffuse);
    sum.under_paper_at_bound += s.chance_at_bound;
    exponent_unlabelled.push_back(s.squared_exponent_unlabelled);
    diffuse_unlabelled.push_back(s.squared_diffuse_unlabelled);
    bayes.push_back(s.bayes_accuracy - s.accuracy);
    normal.push_back(s.normal_accuracy - s.accuracy);
  }
  sum.worst_exponent = median(worst_exponent);
  sum.worst_diffuse = median(worst_diffuse);
  sum.exponent_over_bound = std::sqrt(mean(exponent));
  sum.diffuse_over_bound = std::sqrt(mean(diffuse));
  sum.exponent_over_unlabelled = std::sqrt(mean(exponent_unlabelled));
  sum.diffuse_over_unlabelled = std::sqrt(mean(diffuse_unlabelled));
  sum.short_of_bayes = mean(bayes);
  sum.short_of_normal = mean(normal);
  return sum;
}

}  // namespace lumitexel
