#include "processing/calibration/calibrated_views_file.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/calibration/calibration_summary_json.h"

namespace lumitexel {
namespace {

using nlohmann::json;
constexpr int kVersion = 4;

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
            {"sigma_m", view.light.sigma_m},
            {"radius_m", view.light.radius_m},
            {"pattern", view.light.pattern.parameters()},
            {"pattern_covariance", view.light.pattern.covariance().reshaped()},
            {"lamp_from_world", view.light.lamp_from_world.reshaped()}}}};
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
  view.light.radius_m = light.at("radius_m").get<double>();
  const auto pattern = light.at("pattern").get<std::array<double, 4>>();
  const auto covariance = light.at("pattern_covariance").get<std::array<double, 16>>();
  view.light.pattern = LampPattern(Eigen::Map<const Eigen::Vector4d>(pattern.data()),
                                   Eigen::Map<const Eigen::Matrix4d>(covariance.data()));
  const auto turn = light.at("lamp_from_world").get<std::array<double, 9>>();
  view.light.lamp_from_world = Eigen::Map<const Eigen::Matrix3d>(turn.data());
  return view;
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
    return std::pair{std::move(session), summary_from_json(document.at("summary"))};
  } catch (const json::exception&) {
    return std::nullopt;  // damaged: what is derived is made again
  }
}

}  // namespace lumitexel
