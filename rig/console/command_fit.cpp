#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "drivers/error.h"
#include "processing/brdf/material_basis.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/fit/fit_model.h"
#include "processing/model/model_file.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/materials_option.h"
#include "rig/console/named_value.h"

namespace lumitexel {
namespace {

struct FitSettings {
  std::string session, out, quality = "standard", method = "lumitexel", errors = "auto", bases = "auto", precision = "double";
  int normal_rounds = 1;
  std::string materials, family, lobe_shapes, normals, interreflections;  // empty: as quality and method have it
  std::optional<int> lobes;
  std::optional<std::size_t> learning_points, final_points;
  int draw = 0;
  std::optional<double> intensity_weight;
  bool plain_projection = false, principal_functions = false;
  std::string layout = "auto";
  int atlas_size = 0;
};

template <typename Value>
using Words = std::vector<std::pair<std::string, Value>>;

Words<std::string> quality_words() { return {{"draft", "draft"}, {"standard", "standard"}, {"reference", "reference"}}; }
Words<FitMethod> method_words() { return {{"lumitexel", FitMethod::Lumitexel}, {"paper", FitMethod::Paper}}; }
// None: auto.
Words<std::optional<BrdfFamily>> family_words() {
  Words<std::optional<BrdfFamily>> words;
  for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) words.emplace_back(to_string(family), family);
  words.emplace_back("auto", std::nullopt);
  return words;
}
Words<LobeShapes> shape_words() { return words_by_to_string(std::vector{LobeShapes::Shared, LobeShapes::Separate, LobeShapes::Auto}); }
Words<ErrorSource> error_words() {
  return words_by_to_string(std::vector{ErrorSource::Auto, ErrorSource::Given, ErrorSource::Labels, ErrorSource::Estimated});
}

Words<NormalChoice> normal_words() { return words_by_to_string(std::vector{NormalChoice::Auto, NormalChoice::Fitted, NormalChoice::Texel, NormalChoice::Mesh}); }
Words<InterreflectionChoice> interreflection_words() {
  return words_by_to_string(std::vector{InterreflectionChoice::Auto, InterreflectionChoice::Always, InterreflectionChoice::Off});
}
Words<LayoutChoice> layout_words() {
  return words_by_to_string(std::vector{LayoutChoice::Auto, LayoutChoice::Photographs, LayoutChoice::Mesh});
}

// 0: auto.
int bases_wanted(const std::string& word) {
  Words<int> words{{"auto", 0}};
  for (int k = 1; k <= kMaxBasis; ++k) words.emplace_back(std::to_string(k), k);
  return named_value("--bases", word, words);
}

// The paper's method has no such options, or none to choose.
void require_options_of_the_paper(const FitSettings& settings, const FitOptions& options) {
  const std::string with_paper = " with --method paper";
  if (options.materials == 0) throw BadInput("--materials", "auto" + with_paper, "a number: the paper does not choose it");
  if (options.family != BrdfFamily::Lafortune) throw BadInput("--family", settings.family + with_paper, "lafortune");
  if (options.bases != 0) throw BadInput("--bases", settings.bases + with_paper, "no --bases with it: the paper's texels mix all");
  if (options.precision != Precision::Double) throw BadInput("--precision", settings.precision + with_paper, "double");
  if (!settings.lobe_shapes.empty()) throw BadInput("--lobe-shapes", settings.lobe_shapes + with_paper, "no --lobe-shapes with it: the paper's are separate");
  if (options.errors != ErrorSource::Auto) throw BadInput("--errors", settings.errors + with_paper, "no --errors with it: the paper's method has its own");
}

FitOptions fit_options(const FitSettings& settings) {
  FitOptions options = FitOptions::preset(named_value("--quality", settings.quality, quality_words()));
  const bool paper = named_value("--method", settings.method, method_words()) == FitMethod::Paper;
  if (paper) options = as_published(options);
  if (!settings.materials.empty()) options.materials = materials_wanted("--materials", settings.materials);
  if (!settings.family.empty()) options.family = named_value("--family", settings.family, family_words());
  if (settings.lobes) options.most_lobes = *settings.lobes;
  if (!settings.lobe_shapes.empty()) options.lobe_shapes = named_value("--lobe-shapes", settings.lobe_shapes, shape_words());
  if (!settings.normals.empty()) options.normals = named_value("--normals", settings.normals, normal_words());
  options.normal_rounds = settings.normal_rounds;
  if (!settings.interreflections.empty()) {
    options.interreflections.choice = named_value("--interreflections", settings.interreflections, interreflection_words());
  }
  if (settings.learning_points) options.learning_lumitexels = *settings.learning_points;
  if (settings.final_points) options.final_lumitexels = *settings.final_points;
  options.draw = settings.draw;
  options.errors = named_value("--errors", settings.errors, error_words());
  options.layout = {named_value("--layout", settings.layout, layout_words()), settings.atlas_size};
  if (settings.atlas_size > 0 && options.layout.choice != LayoutChoice::Mesh) {
    throw BadInput("--atlas-size", std::to_string(settings.atlas_size) + " without --layout mesh", "--layout mesh");
  }
  if (settings.intensity_weight) options.intensity_weight = *settings.intensity_weight;
  options.bases = bases_wanted(settings.bases);
  options.precision = named_value<Precision>("--precision", settings.precision, words_by_to_string(std::vector{Precision::Double, Precision::Float}));
  options.principal_functions |= settings.principal_functions;
  options.plain_projection |= settings.plain_projection;
  if (paper) require_options_of_the_paper(settings, options);
  if (!paper && settings.intensity_weight) throw BadInput("--intensity-weight", "without --method paper", "--method paper with it: ours has no such weight");
  if (options.most_lobes == 0 && !(settings.family.empty() && settings.lobe_shapes.empty())) {
    throw BadInput("--lobes", "0 with --family or --lobe-shapes", "1 to 3 with them: without lobes they say nothing");
  }
  if (!paper && options.plain_projection && options.principal_functions) {
    throw BadInput("--principal-functions", "with --plain-projection", "one of both: without a prior no left-out samples say whether functions should move");
  }
  return options;
}

template <typename... Values>
std::string line(const char* format, Values... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// A row's figure of every stage that ran, in Table II's order.
template <typename Figure>
std::string rms_row(const std::string& title, const FitSummary& summary, bool with_normal, Figure figure) {
  std::string text = line("  %-30s", title.c_str());
  for (const StageError* stage : {&summary.single, &summary.cluster, &summary.projection}) text += line(" %9.5f", figure(*stage));
  if (summary.pfa) text += line(" %9.5f", figure(*summary.pfa));
  if (with_normal && summary.normal) text += line(" %9.5f", figure(*summary.normal));
  return text + "\n";
}

std::string rms_table(const FitSummary& summary) {
  std::string text = line("%-32s %9s %9s %9s", "RMS of the samples, 1/sr", "1-RMS", "C-RMS", "P-RMS");
  if (summary.pfa) text += line(" %9s", "F-RMS");
  if (summary.normal) text += line(" %9s", "NF-RMS");
  text += "\n";
  text += rms_row("all", summary, true, [](const StageError& stage) { return stage.rms; });
  for (std::size_t c = 0; c < summary.single.by_channel.size(); ++c) {
    text += rms_row("channel " + std::to_string(c), summary, true, [c](const StageError& stage) { return stage.by_channel[c]; });
  }
  if (summary.normal) text += "  materials of the fit on the mesh's normals\n";
  for (std::size_t j = 0; j < summary.single.by_material.size(); ++j) {
    const std::vector<std::size_t>& texels = summary.normal ? summary.texels_before_normals : summary.texels_by_material;
    text += rms_row(line("material %-2zu %10zu texels", j, texels[j]), summary, false,
                    [j](const StageError& stage) { return stage.by_material[j]; });
  }
  if (summary.normal) text += "  materials of the last fit, on fitted normals\n";
  for (std::size_t j = 0; summary.normal && j < summary.normal->by_material.size(); ++j) {
    const std::string title = line("material %-2zu %10zu texels", j, summary.texels_by_material[j]);
    text += line("  %-*s %9.5f\n", summary.pfa ? 70 : 60, title.c_str(), summary.normal->by_material[j]);
  }
  return text;
}

std::string outlier_line(const Outliers& outliers) {
  std::string reasons;
  for (const OutlierReason reason : kOutlierReasons) {
    reasons += line("%s %zu %s", reasons.empty() ? ":" : ",", outliers.count[static_cast<std::size_t>(reason)], to_string(reason));
  }
  return line("%zu samples are not explained", total_of(outliers.count)) + reasons +
         line(" (the worst %zu: outliers.csv)\n", outliers.worst.size());
}

const char* meaning(ErrorSource errors) {
  switch (errors) {
    case ErrorSource::Labels: return "estimated for telling materials apart, given for fitting them";
    case ErrorSource::Estimated: return "what each material's residuals say";
    case ErrorSource::Given: return "30 % of each prediction and of the median";
    case ErrorSource::Auto: break;
  }
  return "";
}

// The paper's method has an error of its own (its eq. 6) and asks for none.
std::string error_line(const FitOptions& options, const FitSummary& summary) {
  if (options.method == FitMethod::Paper) return "";
  return line("errors: %s (%s)%s\n", to_string(summary.errors), meaning(summary.errors),
              options.errors == ErrorSource::Auto ? ", chosen by left-out samples" : ", as told");
}

// Family and shapes only where they were left to the samples.
std::string lobes_line(const FitOptions& options, const FitSummary& summary) {
  if (options.most_lobes == 0) return "";  // nothing was asked
  std::string text = "lobes of each material:";
  for (const std::size_t lobes : summary.lobes_by_material) text += line(" %zu", lobes);
  text += options.method == FitMethod::Paper ? ", as told\n" : ", as its samples asked for\n";
  if (!options.family) text += line("lobes: %s, the family that predicted left-out samples best\n", to_string(summary.family));
  if (options.lobe_shapes == LobeShapes::Auto && summary.single.by_channel.size() > 1) {
    text += line("lobe shapes: %s: a shape for each colour channel %s left-out samples better\n", to_string(summary.lobe_shapes),
                 summary.lobe_shapes == LobeShapes::Separate ? "predicted" : "did not predict");
  }
  return text;
}

// Only where it was left to the samples.
std::string bases_line(const FitSettings& settings, const FitSummary& summary) {
  if (settings.bases != "auto" || settings.method == "paper" || settings.plain_projection) return "";
  const auto mixed = std::count_if(summary.bases_by_material.begin(), summary.bases_by_material.end(),
                                   [](std::size_t bases) { return bases > 1 + kVariations; });
  const auto all = static_cast<std::ptrdiff_t>(summary.bases_by_material.size());
  if (mixed == all) return all > 1 ? "bases: texels of every material mix other materials too\n" : "";
  if (mixed == 0) return "bases: texels mix only variations of their own material\n";
  return line("bases: texels of %td of %td materials mix other materials too, the others' only variations of their own\n", mixed, all);
}

const char* outcome(const Choice& choice) {
  if (choice.taken) return "taken";
  return choice.gain.share == 0.0 && choice.gain.sigma == 0.0 ? "not taken: no difference" : "not taken";
}

// One a line: what the choice was, and how clear.
std::string choices_of(const FitChoices& fit) {
  if (fit.choices.empty()) return "";
  std::string text = "  " + fit.fit + "\n";
  for (const Choice& choice : fit.choices) {
    const std::string title = choice.of + ": " + choice.candidate + " over " + choice.before;
    text += line("    %-50s %7.2f +- %.2f %%  %s\n", title.c_str(), 100.0 * choice.gain.share, 100.0 * choice.gain.sigma,
                 outcome(choice));
  }
  return text;
}

std::string choices_table(const FitSummary& summary) {
  std::string rows;
  for (const FitChoices& fit : summary.choices) rows += choices_of(fit);
  if (rows.empty()) return "";
  return "What left-out samples said, photographs where a row names them. Gain: how much of their error a candidate saves, +- standard error. Taken from 0.5 % and two standard errors on; a "
         "source of errors from two, estimated ones also if they lose next to nothing\n" + rows;
}

std::string normals_line(const FitSummary& summary) {
  if (!summary.normals_worth) return "";
  const NormalsWorth& worth = *summary.normals_worth;
  return line("normals: %s; on fitted ones a left-out sample's deviance is %.3f +- %.3f lower (asked for: over %.2f and over one sigma)\n",
              worth.enough() ? "fitted" : "the mesh's", worth.gain, worth.gain_sigma, NormalsWorth::kLeastGain);
}

std::string indirect_line(const FitSummary& summary) {
  if (!summary.indirect) return "";
  const IndirectSummary& indirect = *summary.indirect;
  std::string text = line("light between surfaces: can matter on %.1f %% of the surface (estimated to be at most %.3f of a lamp's)",
                          100.0 * static_cast<double>(indirect.concerned) / static_cast<double>(summary.lumitexels), indirect.largest_bound);
  if (indirect.change.empty()) return text + ", so nobody followed it\n";
  if (!indirect.worth) return text + "; what was found is too little to change anything, so it is left in\n";
  const bool shown = indirect.worth->enough(), left_in = !shown && indirect.share == 0.0;
  if (!indirect.worth->judged()) {
    text += "; too few photographs, or too little of it, to say whether it is there";
  } else {
    text += line("; residuals follow what is predicted with a slope of %.2f +- %.2f (asked for: over %.2f and %.0f sigma)", indirect.worth->slope,
                 indirect.worth->sigma, IndirectWorth::kLeastSlope, IndirectWorth::kStandardErrors);
  }
  if (left_in) return text + ", so it is left in\n";
  if (!shown) text += ", but to be taken out always";
  text += line("; %.1f %% of what was photographed there was taken out; each round changed the samples there by", 100.0 * indirect.share);
  for (const double change : indirect.change) text += line(" %.2f %%", 100.0 * change);
  return text + "\n";
}

std::string layout_text(const LayoutSummary& layout) {
  if (layout.of_mesh) {
    std::string text = line("layout: the mesh's own; a texel spans %.2f pixels of its best photograph (%.2f to %.2f over 90 %% of the surface)\n",
                            layout.pixels_a_texel[1], layout.pixels_a_texel[0], layout.pixels_a_texel[2]);
    if (layout.shared_texels > 0) {
      text += line("  %zu texels are read from two charts, which lie closer than a texel: they bleed; a larger --atlas-size helps\n", layout.shared_texels);
    }
    return text;
  }
  std::string text;
  if (!layout.refused.empty()) text += "layout: cut from the photographs; the mesh's own does not serve: " + layout.refused + "\n";
  if (layout.lumitexels_at_texels > 0) {
    text += line("  %zu lumitexels lie at texels instead of pixels: their triangles are too large for texture coordinates to follow the picture\n",
                 layout.lumitexels_at_texels);
  }
  return text;
}

std::string stages_table(const std::vector<StageCost>& stages) {
  int width = 0;
  for (const StageCost& stage : stages) width = std::max(width, static_cast<int>(stage.name.size()));
  std::string text = line("%-*s %8s %9s\n", width + 2, "Stage", "seconds", "peak MB");
  for (const StageCost& stage : stages) {
    text += line("  %-*s %8.2f %9.0f\n", width, stage.name.c_str(), stage.seconds, static_cast<double>(stage.peak_bytes) / 1e6);
  }
  return text;
}

std::string fit_text(const FitSettings& settings, const FitOptions& options, const FitSummary& summary) {
  std::string text = line("%s: %zu %s, %zu lumitexels, %zu samples (%.1f a lumitexel; %zu lumitexels have none)\n",
                          settings.out.c_str(), summary.texels_by_material.size(), summary.texels_by_material.size() == 1 ? "material" : "materials", summary.lumitexels, summary.samples,
                          static_cast<double>(summary.samples) / static_cast<double>(summary.lumitexels), summary.starved);
  if (summary.unseen_triangles > 0) text += line("  %zu triangles are seen by no view\n", summary.unseen_triangles);
  if (!settings.materials.empty() && summary.texels_by_material.size() < static_cast<std::size_t>(std::max(options.materials, 0))) {
    text += line("  fewer materials than the %d asked for: its samples do not tell more apart\n", options.materials);
  }
  text += layout_text(summary.layout);
  text += error_line(options, summary);
  text += lobes_line(options, summary);
  text += bases_line(settings, summary);
  text += choices_table(summary);
  text += normals_line(summary);
  text += indirect_line(summary);
  text += rms_table(summary);
  text += outlier_line(summary.outliers);
  return text + stages_table(summary.stages);
}

CommandResult fit_command(const FitSettings& settings, CommandContext& context) {
  const FitOptions options = fit_options(settings);
  check_model_directory(settings.out);
  const SessionStore store = session_given("SESSION", settings.session);
  StageTimer timer;
  timer.begin("calibration");
  const CalibratedSession session = calibrate_session(store, context.progress);
  const FittedModel fitted = fit_model(session, options, timer, context.progress);
  write_model(settings.out, fitted.model);
  CommandResult result;
  result.json = nlohmann::json::parse(fitted.model.provenance_json);
  result.text = fit_text(settings, options, fitted.summary);
  return result;
}

}  // namespace

void add_fit_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<FitSettings>();
  Command command(app, "fit", "Turn a session into a model: materials, and weights for every texel. Calibrates the session first, into its derived/");
  command.add_option("SESSION", settings->session, "Session to fit: captured or imported").required();
  command.add_option("--out", settings->out, "Folder of the model; a model that is there is replaced").required();
  command.add_option("--quality", settings->quality,
                     "draft: the mesh's normals, and light between surfaces left in; standard: normals where they pay, that light taken out where the photographs show it; "
                     "reference: that light in up to four rounds, with materials learnt on 50,000 surface points instead of 2,000, fitted to all instead of 2,000, "
                     "and lobes as the samples ask for")
      .capture_default_str();
  command.add_option("--materials", settings->materials, "How many materials to look for, 1 to 64, or auto: as many as the samples ask for, at most 20 (default: auto, with --method paper, which does not choose, 4)");
  command.add_option("--method", settings->method,
                     "lumitexel, or paper: clustering, fits and projection as published (Lensch et al. 2003), for comparison")
      .capture_default_str();
  command.add_option("--family", settings->family, "Lobes of this family: " + words_of(family_words()) + ": whichever predicts left-out samples best (default: lafortune, with --quality reference auto)");
  command.add_option("--lobes", settings->lobes, "Most lobes of a material; each must be asked for by its samples (default: 2, with --quality reference 3, with --method paper 1, "
                     "which asks nothing)")
      .range(0, 3);
  command.add_option("--learning-points", settings->learning_points,
                     "Surface points that the materials are learnt on (default: 2000, with --quality reference 50000)")
      .range(100, 10'000'000);
  command.add_option("--final-points", settings->final_points,
                     "Points of its own that each material is fitted to at the end (default: 2000, with --quality reference all)")
      .range(100, 10'000'000);
  command.add_option("--draw", settings->draw,
                     "Which points the materials are learnt on and fitted to: 0, 1, 2, ...; what differs between draws is chance (see tradeoff --draws). All the "
                     "same where there are no more points than that")
      .range(0, 1'000'000);
  command.add_option("--normals", settings->normals,
                     "fitted: normals finer than the mesh's, from all photographs, and then everything once more on them; texel: the same, each texel by "
                     "its own samples alone, as in the paper; mesh: the mesh's own; auto: fitted where photographs left out for it are then predicted better (default: auto, with "
                     "--quality draft and --method paper mesh)");
  command.add_option("--normal-rounds", settings->normal_rounds,
                     "How often normals are fitted and then everything once more on them")
      .range(1, 9)
      .capture_default_str();
  command.add_option("--interreflections", settings->interreflections,
                     "auto: light between the object's own surfaces is predicted where it can matter, and taken out of the samples if they show it; always: "
                     "whether they show it or not; off (default: auto, with --quality draft and --method paper off)");
  command.add_option("--layout", settings->layout,
                     "photographs: an atlas whose texels are the pixels of each surface point's best photograph; mesh: the mesh's own "
                     "texture coordinates, kept as they are; auto: the mesh's if it has some that serve, else photographs")
      .capture_default_str();
  command.add_option("--atlas-size", settings->atlas_size,
                     "Texels a side of the mesh's own layout (default: as fine as the best photographs in the middle)")
      .range(16, 16384);
  command.add_option("--errors", settings->errors,
                     "What a fit takes for noise. given: 30 % of each prediction and of the median; estimated: what each material's "
                     "residuals say, outliers counting less; labels: estimated for telling materials apart, given for fitting "
                     "them; auto: whichever predicts left-out samples best, and estimated also where it loses next to nothing")
      .capture_default_str();
  command.add_flag("--principal-functions", settings->principal_functions,
                   "Also move the basis BRDFs of each material (principal function analysis), where left-out surface points are "
                   "then predicted better; always with --method paper");
  command.add_option("--intensity-weight", settings->intensity_weight,
                     "With --method paper: what intensity counts beside colour when materials are told apart (default: 0.3)")
      .range(1e-3, 1.0);
  command.add_option("--lobe-shapes", settings->lobe_shapes,
                     "shared: one lobe shape for all colour channels of a material; separate: one a channel, as in the paper; auto: "
                     "separate where that predicts left-out samples better (default: shared, with --quality reference auto, with --method paper separate)");
  command.add_option("--bases", settings->bases,
                     "Most BRDFs that a material's texels mix: 1 the material itself; 2 and 3 its variations; up to 8 other materials; "
                     "auto: no more than predict left-out samples better")
      .capture_default_str();
  command.add_option("--precision", settings->precision, "Of the values that texels' weights are computed from: double or float")
      .capture_default_str();
  command.add_flag("--plain-projection", settings->plain_projection,
                   "Project texels by least squares without a prior, as the paper does: closer to the photographs of the "
                   "fit, farther from others");
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return fit_command(*settings, context); };
  });
}

}  // namespace lumitexel
