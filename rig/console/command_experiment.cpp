#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <optional>

#include "drivers/error.h"
#include "processing/brdf/experiment/experiment_rows.h"
#include "processing/brdf/paper_clustering.h"
#include "rig/console/command.h"
#include "rig/console/experiment_page.h"
#include "rig/console/materials_option.h"
#include "rig/console/named_value.h"
#include "rig/console/output_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

struct ExperimentSettings {
  int seeds = 20, first_seed = 1;
  std::optional<std::string> method, materials;
  bool paper = false, automatic = false;  // short for --method paper, --materials auto
  std::vector<std::string> only;
  std::string page;
};

std::string setting_names() {
  std::string names;
  for (const ExperimentRow& row : experiment_settings()) names += (names.empty() ? "'" : ", '") + row.name + "'";
  return names;
}

// throws BadInput
std::vector<ExperimentRow> chosen_rows(const std::vector<std::string>& names) {
  std::vector<ExperimentRow> chosen;
  for (const ExperimentRow& row : experiment_settings()) {
    if (names.empty() || std::find(names.begin(), names.end(), row.name) != names.end()) chosen.push_back(row);
  }
  for (const std::string& name : names) {
    const bool exists = std::any_of(chosen.begin(), chosen.end(), [&](const ExperimentRow& row) { return name == row.name; });
    if (!exists) throw BadInput("--only", "'" + name + "'", "one of " + setting_names());
  }
  return chosen;
}

// How the worlds are clustered; materials 0: as many as the samples ask for.
struct Way {
  bool paper;
  int materials;
  std::string in_words() const {
    return std::string(paper ? "as the paper published it" : "by this program's own method") + ", " +
           (materials == 0 ? "as many materials as the samples ask for" : std::to_string(materials) + (materials == 1 ? " material" : " materials") + " asked for");
  }
};

// throws BadInput
Way chosen_way(const ExperimentSettings& settings) {
  if (settings.paper && settings.method) throw BadInput("--paper", "with --method", "one of both");
  if (settings.automatic && settings.materials) throw BadInput("--auto", "with --materials", "one of both");
  const std::string method = settings.paper ? "paper" : settings.method.value_or("lumitexel");
  const std::string materials = settings.automatic ? "auto" : settings.materials.value_or("5");
  const Way way{named_value<bool>("--method", method, {{"lumitexel", false}, {"paper", true}}), materials_wanted("--materials", materials)};
  if (way.paper && way.materials == 0) throw BadInput("--materials", "auto with --method paper", "a number: the paper does not choose it");
  return way;
}

Clustering cluster(const FiveMaterials& world, const Way& way) {
  LumitexelList all(world.label.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto quiet = [](int) {};
  if (way.paper) return paper_clustering(world.observations, all, {way.materials, 1, 0.3, all.size()}, quiet);
  ClusterOptions options;
  options.materials = way.materials;
  options.final_lumitexels = all.size();
  return cluster_materials(world.observations, all, options, quiet);
}

nlohmann::json number(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); }

nlohmann::json score_json(int seed, const FiveMaterialsScore& s) {
  return {{"seed", seed}, {"materials", s.found}, {"all_found", s.all_found},
          {"squared_exponent_error_in_unlabelled_bounds", number(s.squared_exponent_unlabelled)},
          {"squared_diffuse_error_in_unlabelled_bounds", number(s.squared_diffuse_unlabelled)},
          {"worst_exponent", number(s.worst_exponent)}, {"worst_diffuse", number(s.worst_diffuse)},
          {"exponent_errors_in_bounds", s.log_exponent_error}, {"diffuse_errors_in_bounds", s.diffuse_error},
          {"accuracy", s.accuracy}, {"bayes_accuracy", s.bayes_accuracy}, {"normal_noise_accuracy", s.normal_accuracy}};
}

nlohmann::json row_json(const ExperimentRow& row, const Way& way, int first_seed) {
  const ExperimentTally t = tally(row);
  nlohmann::json json = {{"setting", row.name}, {"method", way.paper ? "paper" : "lumitexel"},
                         {"materials_asked", way.materials == 0 ? nlohmann::json("auto") : nlohmann::json(way.materials)}, {"seeds", t.seeds}, {"five_materials", t.five}, {"all_found", t.found},
                         {"all_within_0.2_percent", t.under_paper},
                         {"all_within_0.2_percent_at_bound", t.under_paper_at_bound},
                         {"worst_exponent_median", number(t.worst_exponent)}, {"worst_diffuse_median", number(t.worst_diffuse)},
                         {"exponent_over_bound", number(t.exponent_over_bound)}, {"diffuse_over_bound", number(t.diffuse_over_bound)},
                         {"exponent_over_unlabelled_bound", number(t.exponent_over_unlabelled)},
                         {"diffuse_over_unlabelled_bound", number(t.diffuse_over_unlabelled)},
                         {"accuracy_short_of_bayes", number(t.short_of_bayes)},
                         {"accuracy_short_of_normal_noise", number(t.short_of_normal)}, {"runs", nlohmann::json::array()}};
  for (std::size_t i = 0; i < row.scores.size(); ++i) json["runs"].push_back(score_json(first_seed + static_cast<int>(i), row.scores[i]));
  return json;
}

// With a dash for what there is not, as wide.
std::string cell(double value, int width, int decimals, const char* unit = "") {
  char text[40];
  if (std::isfinite(value)) std::snprintf(text, sizeof text, "%*.*f%s", width, decimals, value, unit);
  else std::snprintf(text, sizeof text, "%*s%*s", width, "-", static_cast<int>(std::string(unit).size()), "");
  return text;
}

std::string row_text(const ExperimentRow& row) {
  const ExperimentTally t = tally(row);
  char counts[80];
  std::snprintf(counts, sizeof counts, "%-30s %3d   %3d   ", row.name.c_str(), t.five, t.found);
  return counts + cell(100 * t.worst_exponent, 7, 3, " %") + cell(100 * t.worst_diffuse, 8, 3, " %") + cell(t.exponent_over_bound, 8, 2) +
         cell(t.diffuse_over_bound, 7, 2) + cell(t.exponent_over_unlabelled, 8, 2) + cell(t.diffuse_over_unlabelled, 7, 2) +
         cell(t.under_paper, 7, 0) + " of" + cell(t.under_paper_at_bound, 6, 1) + cell(100 * t.short_of_bayes, 8, 2, " %") +
         cell(100 * t.short_of_normal, 8, 2, " %") + '\n';
}

constexpr const char* kTableHead =
    "Five materials of one kd, exponents 36.2 to 60.2, 46,000 samples, 5 % noise (section 11 of the paper)\n"
    "                              five  found   worst N  worst kd  error over the bound for       all within  labels short of\n"
    "                                                median    median  labels known  labels unknown   0.2 %         Bayes    normal\n"
    "                                                                      N     kd       N     kd\n";
constexpr const char* kTableFoot =
    "Bound: Cramer and Rao's for Gaussian noise of this size. Labels unknown: for who is told neither labels nor shares, worked out for Gaussian\n"
    "noise alone. All within 0.2 %: seeds of which all twenty numbers are, and how many they would be for who reaches the bound (labels unknown,\n"
    "where that is worked out). Labels: mean share rightly labelled, less than who knows the true BRDFs, shares and law of the noise (Bayes), and\n"
    "who knows all that but takes the noise for normal.\n";

CommandResult experiment_command(const ExperimentSettings& settings, CommandContext& context) {
  std::vector<ExperimentRow> rows = chosen_rows(settings.only);
  const Way way = chosen_way(settings);
  require_writable_folder("--page", settings.page);
  CommandResult result;
  result.json = nlohmann::json::array();
  result.text = "Clustered " + way.in_words() + "\n" + kTableHead;
  for (ExperimentRow& row : rows) {
    context.progress.begin(row.name, settings.seeds, "seeds");
    for (int seed = 0; seed < settings.seeds; ++seed) {
      const FiveMaterials world = make_five_materials(static_cast<std::uint64_t>(settings.first_seed + seed), row.options);
      row.scores.push_back(score(world, cluster(world, way)));
      context.progress.update(seed + 1);
    }
    result.text += row_text(row);
    result.json.push_back(row_json(row, way, settings.first_seed));
  }
  result.text += kTableFoot;
  if (!settings.page.empty()) {
    write_whole_file(settings.page, experiment_page(rows, way.in_words(), result.json.dump()));
    result.text += settings.page + ": the same as a page with drawings\n";
  }
  return result;
}

}  // namespace

void add_experiment_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<ExperimentSettings>();
  Command command(app, "experiment", "The paper's synthetic experiment: five materials under noise, clustered over many seeds, against the best possible");
  command.add_option("--seeds", settings->seeds, "Seeds for each setting").range(1, 100000).capture_default_str();
  command.add_option("--first-seed", settings->first_seed, "The first of them").capture_default_str();
  command.add_option("--only", settings->only, "These settings only: " + setting_names()).type_name("NAME");
  command.add_option("--page", settings->page, "HTML file to write, with drawings of lobes, errors and labels");
  command.add_option("--method", settings->method, "lumitexel, or paper: clustering as published (default: lumitexel)");
  command.add_option("--materials", settings->materials, "How many materials to look for, 1 to 64, or auto: as many as the samples ask for (default: 5)");
  command.add_flag("--paper", settings->paper, "The same as --method paper");
  command.add_flag("--auto", settings->automatic, "The same as --materials auto");
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return experiment_command(*settings, context); };
  });
}

}  // namespace lumitexel
