#include <algorithm>
#include <memory>

#include "drivers/error.h"
#include "processing/brdf/numerics/numeric_self_test.h"
#include "rig/console/command.h"

namespace lumitexel {
namespace {

struct SelfTestOptions {
  bool numerics = false, full = false;
};

nlohmann::json to_json(const NumericCase& row) {
  nlohmann::json json = {{"case", row.name}, {"asked", row.asked}, {"limit", row.limit}, {"ok", row.ok()}};
  json["largest"] = std::isfinite(row.largest) ? nlohmann::json(row.largest) : nlohmann::json(nullptr);
  if (row.excluded > 0) json["excluded"] = {{"trials", row.excluded}, {"because", row.because}};
  return json;
}

CommandResult run(const SelfTestOptions& options, CommandContext& context) {
  if (!options.numerics) throw BadInput("selftest", "no test named", "--numerics");
  const NumericCases cases = run_numeric_self_test(options.full ? kFullNumericSelfTest : NumericSelfTestOptions{}, [&](int part, int parts) {
    if (part == 0) context.progress.begin("numerics", parts, "parts");
    context.progress.update(part);
  });
  CommandResult result;
  result.text = to_table(cases);
  nlohmann::json rows = nlohmann::json::array();
  for (const NumericCase& row : cases) rows.push_back(to_json(row));
  const auto failed = std::count_if(cases.begin(), cases.end(), [](const NumericCase& row) { return !row.ok(); });
  result.json = {{"numerics", rows}, {"failed", failed}};
  result.text += std::to_string(cases.size()) + " cases, " + std::to_string(failed) + " failed\n";
  result.exit_code = failed > 0 ? 1 : 0;
  return result;
}

}  // namespace

void add_selftest_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<SelfTestOptions>();
  Command command(app, "selftest", "Try this program's own arithmetic on this machine");
  command.add_flag("--numerics", options->numerics, "BRDF kernels and fits at their extremes, against 113-bit arithmetic");
  command.add_flag("--full", options->full, "A million trials a row and ten million lumitexels, instead of 20,000 each");
  command.callback([options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
