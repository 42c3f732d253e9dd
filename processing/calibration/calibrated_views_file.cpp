#include "processing/calibration/calibrated_views_file.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using nlohmann::json;
constexpr int kVersion = 1;

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d vector_from(const json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

json pose_json(const Eigen::Isometry3d& pose) {
  json rows = json::array();
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) rows.push_back(pose.matrix()(r, c));
  }
  return rows;
}

Eigen::Isometry3d pose_from(const json& j) {
  Eigen::Isometry3d pose;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = j.at(static_cast<std::size_t>(4 * r + c)).get<double>();
  }
  return pose;
}

json camera_json(const CameraModel& m) {
  return {{"width_px", m.width_px},
          {"height_px", m.height_px},
          {"params", {m.focal_x_px, m.focal_y_px, m.principal_x_px, m.principal_y_px, m.k1, m.k2, m.p1, m.p2}}};
}

CameraModel camera_from(const json& j) {
  CameraModel m;
  m.width_px = j.at("width_px").get<int>();
  m.height_px = j.at("height_px").get<int>();
  const auto p = j.at("params").get<std::array<double, 8>>();
  m.focal_x_px = p[0], m.focal_y_px = p[1], m.principal_x_px = p[2], m.principal_y_px = p[3];
  m.k1 = p[4], m.k2 = p[5], m.p1 = p[6], m.p2 = p[7];
  return m;
}

json view_json(const View& view) {
  return {{"name", view.name},
          {"heldout", view.heldout},
          {"camera", camera_json(view.camera)},
          {"camera_from_world", pose_json(view.camera_from_world)},
          {"photograph", view.photograph.filename().string()},
          {"light",
           {{"point", view.light.type == Light::Type::Point},
            {"vector", vector_json(view.light.vector_in_world)},
            {"intensity", view.light.intensity},
            {"sigma_m", view.light.sigma_m}}}};
}

View view_from(const json& j, const std::filesystem::path& directory) {
  View view;
  view.name = j.at("name").get<std::string>();
  view.heldout = j.at("heldout").get<bool>();
  view.camera = camera_from(j.at("camera"));
  view.camera_from_world = pose_from(j.at("camera_from_world"));
  view.photograph = directory / j.at("photograph").get<std::string>();
  const json& light = j.at("light");
  view.light.type = light.at("point").get<bool>() ? Light::Type::Point : Light::Type::Directional;
  view.light.vector_in_world = vector_from(light.at("vector"));
  view.light.intensity = light.at("intensity").get<std::vector<double>>();
  view.light.sigma_m = light.at("sigma_m").get<double>();
  return view;
}

json light_json(const LightSummary& l) {
  return {{"view", l.view},
          {"position", vector_json(l.position_in_world)},
          {"sigma_m", l.sigma_m},
          {"from_spheres", l.from_spheres},
          {"highlights", l.highlights},
          {"outliers", l.outliers},
          {"residual_px", l.residual_px},
          {"spheres_alone", vector_json(l.spheres_alone_in_world)},
          {"spheres_alone_sigma_m", l.spheres_alone_sigma_m},
          {"off_the_arm", l.off_the_arm}};
}

LightSummary light_from(const json& j) {
  return {j.at("view").get<std::string>(),
          vector_from(j.at("position")),
          j.at("sigma_m").get<double>(),
          j.at("from_spheres").get<bool>(),
          j.at("highlights").get<int>(),
          j.at("outliers").get<int>(),
          j.at("residual_px").get<double>(),
          vector_from(j.at("spheres_alone")),
          j.at("spheres_alone_sigma_m").get<double>(),
          j.at("off_the_arm").get<bool>()};
}

json summary_json(const CalibrationSummary& s) {
  json lights = json::array();
  for (const LightSummary& light : s.lights) lights.push_back(light_json(light));
  return {{"lights", lights},
          {"sphere_residual_px", s.sphere_residual_px},
          {"sphere_sigma_scale", s.sphere_sigma_scale},
          {"arm_scatter_m", s.arm_scatter_m},
          {"arm_residual_m", s.arm_residual_m},
          {"intensity", s.intensity},
          {"gray_card_pixel_scatter", s.gray_card_pixel_scatter},
          {"scale_sigma", s.scale_sigma},
          {"hot_pixels", s.hot_pixels},
          {"views_without_silhouette", s.views_without_silhouette}};
}

CalibrationSummary summary_from(const json& j) {
  CalibrationSummary s;
  for (const json& light : j.at("lights")) s.lights.push_back(light_from(light));
  s.sphere_residual_px = j.at("sphere_residual_px").get<double>();
  s.sphere_sigma_scale = j.at("sphere_sigma_scale").get<double>();
  s.arm_scatter_m = j.at("arm_scatter_m").get<double>();
  s.arm_residual_m = j.at("arm_residual_m").get<double>();
  s.intensity = j.at("intensity").get<std::vector<double>>();
  s.gray_card_pixel_scatter = j.at("gray_card_pixel_scatter").get<std::vector<double>>();
  s.scale_sigma = j.at("scale_sigma").get<double>();
  s.hot_pixels = j.at("hot_pixels").get<std::int64_t>();
  s.views_without_silhouette = j.at("views_without_silhouette").get<int>();
  return s;
}

}  // namespace

void write_calibrated_views(const std::filesystem::path& directory, const CalibratedSession& session,
                            const CalibrationSummary& summary) {
  json views = json::array();
  for (const View& view : session.views) views.push_back(view_json(view));
  const json document = {{"version", kVersion},
                         {"key", session.key},
                         {"channels", session.channels},
                         {"gray_card_scale_sigma", session.gray_card_scale_sigma},
                         {"views", views},
                         {"summary", summary_json(summary)}};
  const std::filesystem::path temporary = directory / "views.json.part";
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file << document.dump(1) << '\n';
    if (!file.flush()) throw Error(temporary.string() + ": cannot be written");
  }
  std::filesystem::rename(temporary, directory / "views.json");
}

std::optional<std::pair<CalibratedSession, CalibrationSummary>> read_calibrated_views(
    const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / "views.json";
  if (!std::filesystem::exists(path)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  try {
    const json document = json::parse(file);
    if (document.at("version").get<int>() != kVersion) return std::nullopt;
    CalibratedSession session;
    session.key = document.at("key").get<std::string>();
    session.channels = document.at("channels").get<int>();
    session.gray_card_scale_sigma = document.at("gray_card_scale_sigma").get<double>();
    for (const json& view : document.at("views")) {
      session.views.push_back(view_from(view, directory));
      if (!std::filesystem::exists(session.views.back().photograph)) return std::nullopt;
    }
    return std::pair{std::move(session), summary_from(document.at("summary"))};
  } catch (const json::exception&) {
    return std::nullopt;  // damaged: what is derived is made again
  }
}

}  // namespace lumitexel
