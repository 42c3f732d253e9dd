#include "processing/brdf/numerics/numeric_self_test.h"

#include <cstdio>

#include "processing/brdf/numerics/fit_cases.h"
#include "processing/brdf/numerics/kernel_cases.h"
#include "processing/brdf/numerics/scene_cases.h"
#include "processing/brdf/numerics/trapped_run.h"

namespace lumitexel {
namespace {

constexpr std::size_t kTrappedTrials = 2000, kTrappedLumitexels = 2000;

std::vector<TrappedPart> trapped_parts() {
  return {{"double kernels", [] { double_kernel_cases(kTrappedTrials); }}, {"float kernels", [] { float_kernel_cases(kTrappedTrials); }},
          {"objects of every size", [] { scene_cases(kTrappedTrials); }},  {"rank-deficient systems", [] { rank_cases(); }},
          {"fits", [] { fit_cases(); }},                                   {"clustering", [] { extent_cases(kTrappedLumitexels); }}};
}

std::string exclusions(const NumericCases& cases) {
  std::string text;
  for (const NumericCase& row : cases) {
    if (row.excluded > 0) text += "not judged, " + row.name + ", " + row.asked + ": " + std::to_string(row.excluded) + " trials, " + row.because + "\n";
  }
  return text;
}

}  // namespace

NumericCases run_numeric_self_test(const NumericSelfTestOptions& options, const std::function<void(int, int)>& report) {
  const std::vector<std::function<NumericCases()>> parts{
      [] { return NumericCases{run_trapped(trapped_parts())}; },  // first: nothing has started threads yet
      [&] { return double_kernel_cases(options.trials); },
      [&] { return float_kernel_cases(options.trials); },
      [&] { return scene_cases(options.trials); },
      [] { return rank_cases(); },
      [] { return fit_cases(); },
      [&] { return extent_cases(options.lumitexels); },
  };
  NumericCases cases;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    report(static_cast<int>(k), static_cast<int>(parts.size()));
    const NumericCases part = parts[k]();
    cases.insert(cases.end(), part.begin(), part.end());
  }
  report(static_cast<int>(parts.size()), static_cast<int>(parts.size()));
  return cases;
}

std::string to_table(const NumericCases& cases) {
  char line[256];
  std::snprintf(line, sizeof line, "%-62s %-72s %10s %10s\n", "case", "asked", "largest", "limit");
  std::string table = line;
  for (const NumericCase& row : cases) {
    std::snprintf(line, sizeof line, "%-62s %-72s %10.2e %10.2e  %s\n", row.name.c_str(), row.asked.c_str(), row.largest, row.limit,
                  row.ok() ? "ok" : "FAILED");
    table += line;
  }
  return table + "largest: the worst met, limit: the most that passes. Of values and slopes it is the error over max(f, peak / 1000), or over the slope\n"
                 "itself where that is more; of all else what is asked, as a share of what is right or as a count.\n" + exclusions(cases);
}

}  // namespace lumitexel
