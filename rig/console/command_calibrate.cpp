#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <memory>
#include <sstream>

#include "drivers/error.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/calibration_summary_json.h"
#include "processing/report/calibration_report.h"
#include "rig/console/calibration_truth.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/named_value.h"
#include "rig/console/output_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct CalibrateOptions {
  std::string session, page, lens_out;
  std::vector<std::string> without;
};

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
json known_or_null(double sigma) { return sigma > 0.0 ? json(sigma) : json(nullptr); }
json measured_or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json lights_json(const CalibrationSummary& summary) {
  json lights = json::array();
  for (const LightSummary& light : summary.lights) {
    lights.push_back(
        {{"view", light.view},
         {"position_m", vector_json(light.position_in_world)},
         {"sigma_m", known_or_null(light.sigma_m)},
         {"from_spheres", light.from_spheres},
         {"highlights", light.highlights},
         {"outliers", light.outliers},
         {"residual_px", light.residual_px},
         {"spheres_alone_m", light.spheres_alone_sigma_m > 0 ? vector_json(light.spheres_alone_in_world) : json(nullptr)},
         {"spheres_alone_sigma_m", known_or_null(light.spheres_alone_sigma_m)}});
  }
  return lights;
}

json poses_json(const CalibratedSession& session, const CalibrationSummary& summary) {
  json poses = json::array();
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    json rows = json::array();
    const auto& m = session.views[v].camera_from_world.matrix();
    for (int r = 0; r < 4; ++r) rows.push_back({m(r, 0), m(r, 1), m(r, 2), m(r, 3)});
    const PoseSummary pose = v < summary.poses.size() ? summary.poses[v] : PoseSummary{};
    poses.push_back({{"view", session.views[v].name},
                     {"camera_from_world", rows},
                     {"sigma_m", measured_or_null(pose.sigma_m)},
                     {"sigma_deg", measured_or_null(pose.sigma_deg)},
                     {"silhouette_px", measured_or_null(pose.silhouette_px)},
                     {"source", pose.source},
                     {"tags", pose.tags},
                     {"dominant", pose.dominant},
                     {"given_silhouette_px", measured_or_null(pose.given_px)},
                     {"chi_square_of_given", measured_or_null(pose.contradiction)},
                     {"problem", pose.problem}});
  }
  return poses;
}

json camera_json(const CalibratedSession& session, const LensSummary& lens) {
  std::vector<double> params = lens.params;
  if (params.empty()) {  // imported
    if (session.views.empty()) return nullptr;
    const CameraModel& c = session.views[0].camera;
    params = {c.focal_x_px, c.focal_y_px, c.principal_x_px, c.principal_y_px, c.k1, c.k2, c.p1, c.p2};
  }
  return {{"model", "OPENCV"},
          {"params", params},
          {"params_sigma", lens.sigma.empty() ? json(nullptr) : json(lens.sigma)},
          {"corner_sigma_px", measured_or_null(lens.corner_sigma_px)},
          {"reprojection_px", measured_or_null(lens.reprojection_px)}};
}

json result_json(const CalibratedSession& session, const CalibrationSummary& summary) {
  const bool captured = !summary.intensity.empty();
  json result = {{"lights", lights_json(summary)},
                 {"poses", poses_json(session, summary)},
                 {"camera", camera_json(session, summary.lens)},
                 {"scale",
                  {{"value", captured ? json(summary.intensity) : json(nullptr)},
                   {"sigma", known_or_null(session.gray_card_scale_sigma)}}}};
  const json all = summary_json(summary);
  for (const char* key : {"lens", "pose_problem", "shares", "rim_offset_px", "rim_offset_sigma_px"}) result[key] = all.at(key);
  for (const char* key : {"sensor", "lamp", "joint", "stray_lights", "spheres_seen", "sphere_residual_px", "arm_residual_m", "arm_scatter_m", "hot_pixels",
                          "views_without_silhouette"}) {
    result[key] = captured || session.views.empty() ? all.at(key) : json(nullptr);
  }
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void describe_poses(const CalibrationSummary& summary, std::ostream& text) {
  if (!summary.pose_problem.empty()) text << "poses: the rig's description; " << summary.pose_problem << '\n';
  std::vector<double> distances, sigmas_m, sigmas_deg;
  for (const PoseSummary& pose : summary.poses) {
    if (!pose.silhouette_px) continue;
    distances.push_back(*pose.silhouette_px);
    sigmas_m.push_back(pose.sigma_m.value_or(0.0));
    sigmas_deg.push_back(pose.sigma_deg.value_or(0.0));
  }
  if (distances.empty()) return;
  text << "poses: silhouettes within " << median(distances) << " px (median), sigma " << 1e3 * median(sigmas_m)
       << " mm, " << median(sigmas_deg) << " degrees\n";
}

// An imported session: what it was given, held against its masks.
void describe_given(const CalibrationSummary& summary, std::ostream& text) {
  int replaced = 0, confirmed = 0;
  std::vector<double> before, after, sigmas_m, sigmas_deg;
  for (const PoseSummary& pose : summary.poses) {
    replaced += pose.source == "silhouette";
    if (!pose.silhouette_px) continue;
    confirmed += pose.source != "silhouette" && pose.problem.empty();
    before.push_back(*pose.given_px);
    after.push_back(*pose.silhouette_px);
    sigmas_m.push_back(*pose.sigma_m);
    sigmas_deg.push_back(*pose.sigma_deg);
  }
  if (!summary.pose_problem.empty()) text << "poses: as given; " << summary.pose_problem << '\n';
  if (!before.empty()) {
    text << "poses: " << replaced << " of " << summary.poses.size() << " replaced because their silhouettes contradict them, " << confirmed
         << " confirmed; silhouettes within " << median(after) << " px (median; as given " << median(before) << "), sigma "
         << 1e3 * median(sigmas_m) << " mm, " << median(sigmas_deg) << " degrees (median)\n";
  }
  for (const PoseSummary& pose : summary.poses) {
    if (!pose.problem.empty()) text << "  " << pose.view << " keeps its pose: " << pose.problem << '\n';
  }
  if (summary.rim_offset_px) {
    text << "masks: their rims lie " << *summary.rim_offset_px << " ± " << *summary.rim_offset_sigma_px
         << " px outside of the mesh's outline\n";
  }
  text << "lights and scale: as given, nothing here measures them\n";
}

void describe_stray(const StrayLightSummary& light, std::ostream& text) {
  const Eigen::Vector3d& at = light.position_in_rig;
  text << "  stray light " << (light.placed ? "at (" : "far away towards (") << at.x() << ", " << at.y() << ", " << at.z()
       << (light.placed ? ") m" : ")") << " in the rig's frame";
  if (light.placed) text << ", sigma " << 1e3 * light.sigma_m << " mm";
  text << ", on the spheres of";
  for (const std::string& view : light.views) text << ' ' << view;
  text << ": it is in these photographs too, and on the gray card, ";
  if (light.card_share) {
    text << "with " << 100.0 * *light.card_share << " ± " << 100.0 * *light.card_share_sigma << " % of the lamp's light there (the channel with most of it) if nothing shades it";
  } else {
    text << "nobody knows how strongly";
  }
  text << "; nothing is corrected, "
       << (light.counted_in_scale ? "intensities may be too high by about as much, which the scale's sigma covers"
                                  : "and seen in one view alone it is taken not to shine at the card's own shots: the scale's sigma leaves it out")
       << "; move or cover it\n";
}

void describe_lamp_size(const LampSummary& lamp, std::ostream& text) {
  text << "lamp's radius: " << 1e3 * lamp.radius_m << " mm (" << lamp.radius_source << ")";
  if (lamp.highlights_radius_m) {
    text << "; its highlights say " << 1e3 * *lamp.highlights_radius_m << " ± " << 1e3 * *lamp.highlights_radius_sigma_m << " mm"
         << (lamp.highlights_radius_found ? "\n" : ", but the search for it came to no end\n");
  } else if (lamp.highlights_radius_bound_m) {
    text << "; its highlights are a point's, up to " << 1e3 * *lamp.highlights_radius_bound_m << " mm at 95 %\n";
  } else {
    text << "; its highlights tell nothing\n";
  }
}

// Views whose light the spheres did not measure, each with how many of them showed it.
void describe_unmeasured(const std::vector<LightSummary>& lights, std::ostream& text) {
  for (const LightSummary& light : lights) {
    if (light.from_spheres) continue;
    text << "  " << light.view << ": its light stands where the arm says, " << light.highlights
         << " of its highlights could be told; three that agree, and a distance known to half of itself, are a measurement\n";
  }
}

void describe(const CalibratedSession& session, const CalibrationSummary& summary, std::ostream& text) {
  constexpr int kDigits = 4;  // no sigma is known better
  text << std::setprecision(kDigits);
  text << session.views.size() << " views calibrated, " << session.channels << " channels\n";
  const LensSummary& lens = summary.lens;
  if (lens.reprojection_px) {
    text << "lens: " << lens.source << ", " << lens.boards << " boards, re-projection " << *lens.reprojection_px << " px rms";
    if (lens.corner_sigma_px) text << ", sigma in the corners " << *lens.corner_sigma_px << " px";
    if (lens.corner_transmission) text << ", transmission in the corner " << *lens.corner_transmission;
    text << '\n';
  }
  for (const std::string& note : lens.notes) text << "  " << note << '\n';
  if (summary.intensity.empty()) {
    if (!session.views.empty()) describe_given(summary, text);
    return;
  }
  const auto measured = std::count_if(summary.lights.begin(), summary.lights.end(),
                                      [](const LightSummary& light) { return light.from_spheres; });
  describe_poses(summary, text);
  if (summary.joint.tried) {
    text << "joint refinement: highlights move lens and poses by chi square " << summary.joint.chi2_gain
         << (summary.joint.taken ? ", taken\n" : ", not significant, not taken\n");
  }
  text << "light: " << measured << " of " << summary.lights.size() << " measured by the spheres, highlights fit to "
       << summary.sphere_residual_px << " px rms on " << summary.spheres_seen << " spheres, arm within "
       << 1e3 * summary.arm_residual_m << " mm rms\n";
  describe_unmeasured(summary.lights, text);
  for (const StrayLightSummary& light : summary.stray_lights) describe_stray(light, text);
  describe_lamp_size(summary.lamp, text);
  text << "scale: gray card to " << 100.0 * summary.scale_sigma << " %, the lamp's intensity";
  for (const double intensity : summary.intensity) text << ' ' << intensity;
  text << " m^2 in the unit of the photographs' radiance\nlamp: " << (summary.lamp.drifts ? "drifts" : "steady, as far as can be told") << ", "
       << (summary.lamp.pattern_parameters > 0 ? "with" : "no") << " angular pattern; card read in "
       << summary.lamp.card_views << " views\nsensor (" << summary.sensor.source << "): "
       << summary.sensor.electrons_per_dn << " e/DN, read noise " << summary.sensor.read_noise_dn << " DN, "
       << summary.hot_pixels << " hot pixels; darks scaled in " << summary.sensor.brackets_with_scaled_darks
       << " brackets\n";
  for (const std::string& note : summary.sensor.notes) text << "  " << note << '\n';
  if (summary.views_without_silhouette > 0) {
    text << summary.views_without_silhouette << " views masked by the mesh alone\n";
  }
}

const char* meaning(CalibrationStep step) {
  switch (step) {
    case CalibrationStep::PhotonTransfer: return "the sensor's noise from the frames";
    case CalibrationStep::Response: return "its curve";
    case CalibrationStep::DarkScale: return "darks scaled to the frames' temperature";
    case CalibrationStep::Lens: return "the lens from boards, of an import from masks";
    case CalibrationStep::Vignetting: return "its shading from flat fields";
    case CalibrationStep::Pose: return "the object's place from silhouettes and tags";
    case CalibrationStep::Joint: return "lens and poses once more with the highlights";
    case CalibrationStep::CardPose: return "the gray card's place from its tags";
    case CalibrationStep::LampDrift: return "the lamp's output in every view";
    case CalibrationStep::LampPattern: return "its output by direction";
  }
  return "";
}

std::string step_help() {
  std::string text;
  for (const CalibrationStep step : all_calibration_steps()) {
    text += std::string(text.empty() ? "" : "; ") + to_string(step) + " (" + meaning(step) + ")";
  }
  return text;
}

void copy_lens_file(const fs::path& derived, const std::string& out) {
  if (!fs::exists(derived / "lens.json")) {
    throw BadInput("--lens-out", "this session's boards calibrate no lens",
                   "a session with board shots (a plan with [lens]); see what calibrate says of them");
  }
  fs::copy_file(derived / "lens.json", out, fs::copy_options::overwrite_existing);
}

CalibrationOptions steps_of(const CalibrateOptions& options) {
  CalibrationOptions steps;
  for (const std::string& name : options.without) steps.without.insert(named_value("--without", name, words_by_to_string(all_calibration_steps())));
  return steps;
}

CommandResult run(const CalibrateOptions& options, CommandContext& context) {
  const CalibrationOptions steps = steps_of(options);
  require_writable_folder("--page", options.page);
  require_writable_folder("--lens-out", options.lens_out);
  const SessionStore store = session_given("SESSION", options.session);
  CalibrationSummary summary;
  const CalibratedSession session = calibrate_session(store, context.progress, &summary, steps);
  CommandResult result;
  std::ostringstream text;
  result.json = result_json(session, summary);
  describe(session, summary, text);
  const std::optional<TruthComparison> truth = compare_with_truth(store.directory(), session, summary);
  if (truth) {
    result.json.update(json::parse(truth->json));
    text << truth->text;
  }
  const fs::path derived = store.derived_directory() / "calibrated" / session.key;
  if (!options.lens_out.empty()) copy_lens_file(derived, options.lens_out);
  if (!options.page.empty()) {
    write_whole_file(options.page, calibration_report(session, summary, derived, truth ? truth->text : "", result.json.dump()));
  }
  result.text = text.str();
  return result;
}

}  // namespace

void add_calibrate_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<CalibrateOptions>();
  Command command(app, "calibrate", "Sensor, lens, poses, light positions, absolute scale, radiance; with uncertainties. Kept in SESSION/derived, where fit finds them");
  command.add_option("SESSION", options->session, "The session's folder").required();
  command.add_option("--page", options->page, "Writes what was found as one HTML page, with pictures");
  command.add_option("--lens-out", options->lens_out, "Writes the lens calibration, for capture --lens");
  command.add_option("--without", options->without,
                     "Leaves steps out, to see what they are worth, several by commas. STEP is one of " + step_help())
      .type_name("STEP")
      .delimiter(',');
  command.callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
