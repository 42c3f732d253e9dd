#include "rig/console/experiment_page.h"

#include <cmath>
#include <cstdio>

#include "processing/report/html.h"
#include "processing/report/page_style.h"

namespace lumitexel {
namespace {

std::string percent(double share, int decimals) {
  if (!std::isfinite(share)) return "–";
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.*f %%", decimals, 100.0 * share);
  return buffer;
}

std::string both(double exponent, double diffuse) { return html::number(exponent) + ", " + html::number(diffuse); }

std::string seeds_text(std::size_t seeds) { return std::to_string(seeds) + (seeds == 1 ? " seed" : " seeds"); }

std::string table_section(const std::vector<ExperimentRow>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const ExperimentRow& row : rows) {
    const ExperimentTally t = tally(row);
    cells.push_back({row.name, std::to_string(t.found) + " of " + std::to_string(t.seeds),
                     both(100.0 * t.worst_exponent, 100.0 * t.worst_diffuse) + " %", both(t.exponent_over_bound, t.diffuse_over_bound),
                     both(t.exponent_over_unlabelled, t.diffuse_over_unlabelled), std::to_string(t.under_paper),
                     html::number(t.under_paper_at_bound), percent(t.short_of_bayes, 2), percent(t.short_of_normal, 2)});
  }
  return html::section(
      "All settings",
      "Found: five materials, each exponent nearest to its own truth. Worst N and kd: medians over the seeds of the largest relative error. Error "
      "over bound: root mean square over seeds and parameters, of N and of kd; 1 is Cramér and Rao's bound for Gaussian noise of this size. Labels "
      "known: for who is told which lumitexel is of which material; unknown: for who is told neither that nor the shares, worked out for Gaussian noise "
      "alone. Under 0.2 %: seeds of which all twenty numbers are, and how many they would be for who reaches the bound (labels unknown, where that "
      "is worked out). Short of: how much smaller the share rightly labelled is than that of somebody who knows the true BRDFs, shares and law of the "
      "noise (Bayes), or all that but takes the noise for normal.",
      html::table({"setting", "found", "worst N, kd", "labels known", "unknown", "under 0.2 %", "at the bound", "short of Bayes", "of normal"}, cells));
}

std::string labels_section(const std::vector<ExperimentRow>& rows) {
  const std::string plot = labels_plot(rows);
  if (plot.empty()) return "";
  return html::section("Labels", "Nobody can label every lumitexel: most saw too little of their highlight.",
                       html::figure(plot, "Blue: this clustering, a stroke a seed and a dot for their mean. Orange bar: the true BRDFs with the noise taken for "
                                          "normal. Black bar: the true BRDFs with the true law of the noise, which nobody beats but by luck."));
}

std::string row_section(const ExperimentRow& row) {
  const std::string lobes = lobes_plot(row);
  if (lobes.empty()) return html::section(row.name, "No seed found all five.", "");
  return html::section(row.name, "Of the " + seeds_text(static_cast<std::size_t>(tally(row).found)) + " with all five found.",
                       html::figure(lobes, "Above: the five lobes as they are. Below: how much the recovered ones differ; nine seeds of ten lie within the band, "
                                           "the line is the median.") +
                           html::figure(bounds_plot(row), "Each parameter's error over its bound, with the uncertainty that this number of seeds "
                                                          "leaves; orange: the goal. Materials by their exponents, N1 the smallest."));
}

}  // namespace

std::string experiment_page(const std::vector<ExperimentRow>& rows, const std::string& way, const std::string& json) {
  std::string body = "<header><h1>Five materials under noise</h1>\n<p>Section 11 of the paper: five materials of one diffuse colour that differ only in "
                     "their exponents, some 46,000 samples with 5 % noise, clustered without being told which is which: " + html::escaped(way) + ". " +
                     seeds_text(rows.empty() ? 0 : rows[0].scores.size()) + " each.</p></header>\n";
  body += table_section(rows) + labels_section(rows);
  for (const ExperimentRow& row : rows) body += row_section(row);
  return html::page("Five materials under noise", kPageStyle, body, json);
}

}  // namespace lumitexel
