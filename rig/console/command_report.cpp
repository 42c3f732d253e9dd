#include <filesystem>
#include <memory>
#include <optional>

#include "processing/report/model_report.h"
#include "processing/report/viewer/viewer_section.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/output_file.h"
#include "rig/whole_file.h"
#include "sim/sgd_brdf.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct ReportSettings {
  std::string model, session, out;
  bool without_viewer = false;
};

std::string title_of(const fs::path& model) {
  const fs::path whole = fs::absolute(model).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::vector<KnownMaterial> measured_materials() {
  std::vector<KnownMaterial> known;
  for (const std::string& name : sgd_table_names(measured_sgd_table())) {
    const SgdBrdf brdf = sgd_from_table(measured_sgd_table(), name, "the built-in table of measured materials");
    known.push_back({name, [brdf](const LobeGeometry& geometry) {
                       const Eigen::Array3d f = evaluate(brdf, geometry);
                       return ChannelValues{f[0], f[1], f[2]};
                     }});
  }
  return known;
}

// Samples only of the photographs that the model was fitted to.
std::string viewer_of(const ReportSubject& subject, CommandContext& context) {
  if (subject.model.mesh.triangles.size() > kMostViewerTriangles) return viewer_left_out(subject.model.mesh.triangles.size());
  if (subject.evaluation == nullptr || !subject.evaluation->same_session) return viewer_section(viewer_page(subject.name, subject.model));
  const LumitexelRecords records = lumitexel_records(subject.model, *subject.session, context.progress);
  const ViewerSamples samples{*subject.session, records, kMostViewerBytes - kMostViewerBytes / 20};  // packed once more it may grow by a hundredth
  return viewer_section(viewer_page(subject.name, subject.model, &samples));
}

CommandResult report_command(const ReportSettings& settings, CommandContext& context) {
  require_writable_folder("--page", settings.out);
  const Model model = model_given("MODEL", settings.model);
  const fs::path out = settings.out.empty() ? fs::path(settings.model) / "report.html" : fs::path(settings.out);
  require_writable_folder("--page", out);  // the usual place, too
  std::optional<CalibratedSession> session;
  std::optional<Evaluation> evaluation;
  CalibrationSummary calibration;
  std::vector<PhotographExposure> exposures;
  if (!settings.session.empty()) {
    const SessionStore store = session_given("--session", settings.session);
    session = calibrate_session(store, context.progress, &calibration);
    evaluation = evaluate_model(model, *session, context.progress);
    exposures = photograph_exposures(store, *session, context.progress);
  }
  ReportSubject subject{title_of(settings.model), model};
  if (session) {
    subject.session = &*session;
    subject.evaluation = &*evaluation;
    subject.calibration = &calibration;
    subject.exposures = exposures;
  }
  const std::vector<KnownMaterial> known = measured_materials();
  if (model.channels == kMaxChannels) {
    subject.known = known;
    subject.known_source = "the MERL database of measured materials, as fitted by Bagher, Soler and Holzschuch (2012)";
  }
  if (!settings.without_viewer) subject.viewer = viewer_of(subject, context);
  const std::string data = report_json(subject);
  const std::string page = model_report(subject, data, context.progress);
  write_whole_file(out, page);

  CommandResult result;
  result.json = nlohmann::json::parse(data);
  result.json.update({{"out", out.string()}, {"bytes", page.size()}});
  result.text =
      out.string() + ": open it in a browser (" + std::to_string(page.size() / 1024) + " KiB, works offline)\n";
  return result;
}

}  // namespace

void add_report_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<ReportSettings>();
  Command command(app, "report", "One self-contained HTML page: pictures, errors, materials, timings");
  command.add_option("MODEL", settings->model, "Folder of the model").required();
  command.add_option("--session", settings->session, "Session whose photographs are shown beside their re-renderings, and their samples in the interactive view");
  command.add_option("--out,--page", settings->out, "HTML file to write (default: MODEL/report.html)");
  command.add_flag("--without-viewer", settings->without_viewer,
                   "Leave out the interactive view, which adds about as much to the page as lumitexel view writes (at most 16 MB, with as many samples as fit)");
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return report_command(*settings, context); };
  });
}

}  // namespace lumitexel
