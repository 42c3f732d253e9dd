#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>

#include "drivers/error.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "rig/console/command.h"

namespace lumitexel {
namespace {

using nlohmann::json;

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
json known_or_null(double sigma) { return sigma > 0.0 ? json(sigma) : json(nullptr); }

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
         {"spheres_alone_m", light.highlights > 0 ? vector_json(light.spheres_alone_in_world) : json(nullptr)},
         {"spheres_alone_sigma_m", known_or_null(light.spheres_alone_sigma_m)}});
  }
  return lights;
}

json poses_json(const CalibratedSession& session) {
  json poses = json::array();
  for (const View& view : session.views) {
    json rows = json::array();
    const auto& m = view.camera_from_world.matrix();
    for (int r = 0; r < 4; ++r) rows.push_back({m(r, 0), m(r, 1), m(r, 2), m(r, 3)});
    // Poses come from the rig's geometry or the import as they are: nothing measures their uncertainty yet.
    poses.push_back({{"view", view.name},
                     {"camera_from_world", rows},
                     {"sigma_m", nullptr},
                     {"sigma_deg", nullptr},
                     {"silhouette_px", nullptr}});
  }
  return poses;
}

json camera_json(const CameraModel& c) {
  return {{"model", "OPENCV"},
          {"params", {c.focal_x_px, c.focal_y_px, c.principal_x_px, c.principal_y_px, c.k1, c.k2, c.p1, c.p2}},
          {"reprojection_px", nullptr}};
}

// Distances to the simulated world's truth, where the session carries it.
struct ErrorFigures {
  double median_mm = 0, max_mm = 0;
};

template <typename Position>
std::optional<ErrorFigures> light_error(const json& truth, const CalibrationSummary& summary,
                                        const Position& position) {
  std::map<std::string, Eigen::Vector3d> true_positions;
  for (const json& light : truth.at("lights")) {
    const auto p = light.at("position_m").get<std::array<double, 3>>();
    true_positions[light.at("view").get<std::string>()] = {p[0], p[1], p[2]};
  }
  std::vector<double> errors_mm;
  for (const LightSummary& light : summary.lights) {
    const auto found = true_positions.find(light.view);
    if (found != true_positions.end() && light.highlights > 0) {
      errors_mm.push_back(1e3 * (position(light) - found->second).norm());
    }
  }
  if (errors_mm.empty()) return std::nullopt;
  std::sort(errors_mm.begin(), errors_mm.end());
  return ErrorFigures{errors_mm[errors_mm.size() / 2], errors_mm.back()};
}

void add_truth(const std::filesystem::path& directory, const CalibrationSummary& summary, json& result,
               std::ostream& text) {
  const std::filesystem::path path = directory / "truth" / "calibration.json";
  if (!std::filesystem::exists(path)) return;
  std::ifstream file(path);
  try {
    const json truth = json::parse(file);
    const auto final_error = light_error(truth, summary, [](const LightSummary& l) { return l.position_in_world; });
    const auto spheres_error =
        light_error(truth, summary, [](const LightSummary& l) { return l.spheres_alone_in_world; });
    if (!final_error || !spheres_error) return;
    result["light_error_mm"] = {{"median", final_error->median_mm}, {"max", final_error->max_mm}};
    result["light_error_spheres_alone_mm"] = {{"median", spheres_error->median_mm}, {"max", spheres_error->max_mm}};
    text << "light position error against the simulated truth: median " << final_error->median_mm << " mm, max "
         << final_error->max_mm << " mm (by the spheres alone " << spheres_error->median_mm << ", "
         << spheres_error->max_mm << ")\n";
  } catch (const json::exception& error) {
    throw Corrupt(path.string() + ": " + error.what());
  }
}

void describe(const CalibratedSession& session, const CalibrationSummary& summary, std::ostream& text) {
  text << session.views.size() << " views calibrated, " << session.channels << " channels\n";
  const auto measured = std::count_if(summary.lights.begin(), summary.lights.end(),
                                      [](const LightSummary& light) { return light.from_spheres; });
  if (summary.intensity.empty()) return;  // imported: nothing was measured here
  text << "light: " << measured << " of " << summary.lights.size() << " measured by the spheres, highlights fit to "
       << summary.sphere_residual_px << " px rms, arm within " << 1e3 * summary.arm_residual_m << " mm rms\n"
       << "scale: gray card to " << 100.0 * summary.scale_sigma << " %, intensity";
  for (const double intensity : summary.intensity) text << ' ' << intensity;
  text << "\nsensor: " << summary.hot_pixels << " hot pixels; " << summary.views_without_silhouette
       << " views masked by the mesh alone\n";
}

CommandResult run(const std::string& directory, CommandContext& context) {
  const SessionStore store = SessionStore::open(directory, OpenMode::ReadOnly);
  CalibrationSummary summary;
  const CalibratedSession session = calibrate_session(store, context.progress, &summary);
  CommandResult result;
  std::ostringstream text;
  const bool captured = !summary.intensity.empty();
  result.json = {{"lights", lights_json(summary)},
                 {"poses", poses_json(session)},
                 {"camera", session.views.empty() ? json(nullptr) : camera_json(session.views[0].camera)},
                 {"scale",
                  {{"value", captured ? json(summary.intensity) : json(nullptr)},
                   {"sigma", known_or_null(session.gray_card_scale_sigma)}}},
                 {"sphere_residual_px", captured ? json(summary.sphere_residual_px) : json(nullptr)},
                 {"arm_residual_m", captured ? json(summary.arm_residual_m) : json(nullptr)},
                 {"arm_scatter_m", captured ? json(summary.arm_scatter_m) : json(nullptr)},
                 {"hot_pixels", captured ? json(summary.hot_pixels) : json(nullptr)},
                 {"views_without_silhouette", captured ? json(summary.views_without_silhouette) : json(nullptr)}};
  describe(session, summary, text);
  add_truth(store.directory(), summary, result.json, text);
  result.text = text.str();
  return result;
}

}  // namespace

void add_calibrate_command(CLI::App& app, CommandAction& action) {
  const auto directory = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("calibrate", "Darks, light positions, poses, absolute scale, radiance");
  command->add_option("SESSION", *directory, "The session's folder")->required();
  command->callback(
      [directory, &action] { action = [directory](CommandContext& context) { return run(*directory, context); }; });
}

}  // namespace lumitexel
