#include <cmath>
#include <cstdio>
#include <memory>

#include "processing/evaluation/evaluate_model.h"
#include "processing/evaluation/stage_caution.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"

namespace lumitexel {
namespace {

struct EvaluateSettings {
  std::string model, session;
};

std::string row(const std::string& name, const ImageError& error) {
  char line[160];
  std::snprintf(line, sizeof line, "  %-28s %10.4f %10.4f %10.4f %9.2f\n", name.c_str(), error.relative_rms,
                error.clipped_rms, error.sqrt_rms, error.psnr_db);
  return line;
}

std::string heading(const std::string& title) {
  char line[160];
  std::snprintf(line, sizeof line, "%-30s %10s %10s %10s %9s\n", title.c_str(), "relative", "clipped", "sqrt",
                "PSNR dB");
  return line;
}

std::string stage_rows(const ErrorByStage& errors) {
  std::string text;
  for (const FitStage stage : kFitStages) {
    const auto& error = errors[static_cast<std::size_t>(stage)];
    if (error && std::isfinite(error->relative_rms)) text += row(to_string(stage), *error);
  }
  return text.empty() ? "  none\n" : text;
}

// In the same photographs; the object's other pixels show texels without samples of their own, to which neighbours lend.
std::string measured_rows(const Evaluation& evaluation) {
  char title[60];
  std::snprintf(title, sizeof title, "measured surface (%.1f %%)", 100.0 * evaluation.heldout_measured_share);
  return heading(title) + stage_rows(evaluation.heldout_measured);
}

std::string caution_line(const Evaluation& evaluation) {
  const std::string words = in_words(stage_cautions(evaluation), evaluation.last_stage);
  return words.empty() ? "" : "caution: " + words + "\n";
}

std::string sample_rows(const nlohmann::json& rms) {
  std::string text = "RMS of the fit's reflectance samples\n";
  for (const FitStage stage : kFitStages) {
    const nlohmann::json& value = rms.at(to_string(stage));
    if (!value.is_number()) continue;
    char line[80];
    std::snprintf(line, sizeof line, "  %-28s %10.5f\n", to_string(stage), value.get<double>());
    text += line;
  }
  return text;
}

std::string evaluation_text(const Evaluation& evaluation, const nlohmann::json& json) {
  std::string text = heading("held-out photographs") + stage_rows(evaluation.heldout);
  if (std::isfinite(evaluation.heldout_measured_share)) text += measured_rows(evaluation);
  text += heading("photographs of the fit") + stage_rows(evaluation.fit);
  text += heading(std::string("views at stage ") + to_string(evaluation.last_stage));
  for (const ViewEvaluation& view : evaluation.views) {
    text += row(view.image + (view.heldout ? " (held out)" : ""), view.error);
  }
  return text + sample_rows(json.at("rms")) + caution_line(evaluation);
}

CommandResult evaluate_command(const EvaluateSettings& settings, CommandContext& context) {
  const Model model = model_given("MODEL", settings.model);
  const SessionStore store = session_given("SESSION", settings.session);
  const CalibratedSession session = calibrate_session(store, context.progress);
  const Evaluation evaluation = evaluate_model(model, session, context.progress);
  if (!evaluation.same_session) {
    std::fprintf(stderr, "note: %s was not fitted to %s as it is now; evaluating across sessions\n",
                 settings.model.c_str(), settings.session.c_str());
  }
  CommandResult result;
  result.json = nlohmann::json::parse(evaluation_json(evaluation));
  result.text = evaluation_text(evaluation, result.json);
  return result;
}

}  // namespace

void add_evaluate_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<EvaluateSettings>();
  Command command(app, "evaluate", "Compare a model with a session's photographs, held-out ones apart");
  command.add_option("MODEL", settings->model, "Folder of the model").required();
  command.add_option("SESSION", settings->session, "Session to compare with, as a rule the one it was fitted to")
      .required();
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return evaluate_command(*settings, context); };
  });
}

}  // namespace lumitexel
