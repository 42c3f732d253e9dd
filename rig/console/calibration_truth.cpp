#include "rig/console/calibration_truth.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using nlohmann::json;

struct Figures {
  double median = 0, largest = 0;
};

std::optional<Figures> figures_of(std::vector<double> errors) {
  if (errors.empty()) return std::nullopt;
  std::sort(errors.begin(), errors.end());
  return Figures{errors[errors.size() / 2], errors.back()};
}

json figures_json(const std::optional<Figures>& figures) {
  return figures ? json{{"median", figures->median}, {"max", figures->largest}} : json(nullptr);
}

std::map<std::string, json> by_view(const json& list) {
  std::map<std::string, json> entries;
  for (const json& entry : list) entries[entry.at("view").get<std::string>()] = entry;
  return entries;
}

Eigen::Isometry3d pose_from(const json& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      pose.matrix()(r, c) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c)).get<double>();
    }
  }
  return pose;
}

template <typename Position>
std::optional<Figures> light_error_mm(const json& truth, const CalibrationSummary& summary, const Position& position) {
  const std::map<std::string, json> lights = by_view(truth.at("lights"));
  std::vector<double> errors;
  for (const LightSummary& light : summary.lights) {
    const auto found = lights.find(light.view);
    const std::optional<Eigen::Vector3d> measured = position(light);
    if (found == lights.end() || !measured) continue;
    const auto p = found->second.at("position_m").get<std::array<double, 3>>();
    errors.push_back(1e3 * (*measured - Eigen::Vector3d(p[0], p[1], p[2])).norm());
  }
  return figures_of(std::move(errors));
}

Eigen::Vector3d middle_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : mesh.positions) box.extend(x);
  return box.center();
}

struct PoseErrors {
  std::optional<Figures> shift_mm, turn_deg;
};

// Of the object's middle before the camera.
PoseErrors pose_errors(const json& truth, const CalibratedSession& session) {
  const std::map<std::string, json> poses = by_view(truth.at("poses"));
  const Eigen::Vector3d middle = middle_of(session.mesh);
  std::vector<double> shifts, turns;
  for (const View& view : session.views) {
    const auto found = poses.find(view.name);
    if (found == poses.end()) continue;
    const Eigen::Isometry3d true_pose = pose_from(found->second.at("camera_from_world"));
    shifts.push_back(1e3 * (view.camera_from_world * middle - true_pose * middle).norm());
    const Eigen::AngleAxisd turn(view.camera_from_world.linear() * true_pose.linear().transpose());
    turns.push_back(std::abs(turn.angle()) * 180.0 / std::numbers::pi);
  }
  return {figures_of(std::move(shifts)), figures_of(std::move(turns))};
}

// Relative, of the irradiance at the object's middle: what intensity, pattern and position make together.
std::optional<Figures> irradiance_error(const json& truth, const CalibratedSession& session) {
  const std::map<std::string, json> lights = by_view(truth.at("lights"));
  const json lamp = truth.value("lamp", json::object());
  const double exponent = lamp.value("pattern_exponent", 0.0);
  const Eigen::Vector3d middle = middle_of(session.mesh);
  std::vector<double> errors;
  for (const View& view : session.views) {
    const auto found = lights.find(view.name);
    if (found == lights.end() || !found->second.contains("intensity")) continue;
    const auto p = found->second.at("position_m").get<std::array<double, 3>>();
    const auto axis = found->second.at("axis").get<std::array<double, 3>>();
    const Eigen::Vector3d ray = middle - Eigen::Vector3d(p[0], p[1], p[2]);
    const double cosine = ray.normalized().dot(Eigen::Vector3d(axis[0], axis[1], axis[2]));
    const auto intensity = found->second.at("intensity").get<std::vector<double>>();
    double worst = 0.0;
    for (std::size_t c = 0; c < intensity.size(); ++c) {
      const double expected = intensity[c] * std::pow(cosine, exponent) / ray.squaredNorm();
      worst = std::max(worst, std::abs(view.light.irradiance(middle, static_cast<int>(c)) / expected - 1.0));
    }
    errors.push_back(worst);
  }
  return figures_of(std::move(errors));
}

// The farthest that the lens puts any direction of the picture from where it belongs.
double lens_error_px(const json& truth, const CameraModel& camera) {
  const auto p = truth.at("camera").at("params").get<std::array<double, 8>>();
  CameraModel true_camera{camera.width_px, camera.height_px, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]};
  double worst = 0.0;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      const Eigen::Vector2d pixel(camera.width_px * i / 8.0, camera.height_px * j / 8.0);
      worst = std::max(worst, (camera.project(true_camera.unproject(pixel)) - pixel).norm());
    }
  }
  return worst;
}

void tell(std::ostream& text, const char* what, const std::optional<Figures>& figures, double factor, const char* unit) {
  if (!figures) return;
  text << "  " << what << ": median " << factor * figures->median << ", max " << factor * figures->largest << ' ' << unit
       << '\n';
}

TruthComparison compare(const json& truth, const CalibratedSession& session, const CalibrationSummary& summary) {
  const auto known = [](const Eigen::Vector3d& position, double sigma_m) {
    return sigma_m > 0.0 ? std::optional(position) : std::nullopt;
  };
  const auto lights = light_error_mm(truth, summary, [&](const LightSummary& l) { return known(l.position_in_world, l.sigma_m); });
  const auto alone = light_error_mm(truth, summary, [&](const LightSummary& l) {
    return known(l.spheres_alone_in_world, l.spheres_alone_sigma_m);
  });
  const PoseErrors poses = pose_errors(truth, session);
  const std::optional<Figures> irradiance = irradiance_error(truth, session);
  std::ostringstream text;
  text << "against the simulated truth\n";
  tell(text, "light positions", lights, 1.0, "mm");
  tell(text, "by each view's spheres alone", alone, 1.0, "mm");
  tell(text, "object before the camera, shift", poses.shift_mm, 1.0, "mm");
  tell(text, "object before the camera, turn", poses.turn_deg, 1.0, "degrees");
  tell(text, "irradiance at the object's middle", irradiance, 100.0, "%");
  json lens = nullptr;
  if (!session.views.empty()) {
    lens = lens_error_px(truth, session.views[0].camera);
    text << "  lens: at most " << lens.get<double>() << " px";
    if (summary.lens.corner_sigma_px) text << " (stated sigma in the corners " << *summary.lens.corner_sigma_px << ')';
    text << '\n';
  }
  const json figures = {{"light_error_mm", figures_json(lights)},
                        {"light_error_spheres_alone_mm", figures_json(alone)},
                        {"pose_error_mm", figures_json(poses.shift_mm)},
                        {"pose_error_deg", figures_json(poses.turn_deg)},
                        {"irradiance_error", figures_json(irradiance)},
                        {"lens_error_px", lens}};
  return {text.str(), figures.dump()};
}

}  // namespace

std::optional<TruthComparison> compare_with_truth(const std::filesystem::path& session_directory,
                                                  const CalibratedSession& session, const CalibrationSummary& summary) {
  const std::filesystem::path path = session_directory / "truth" / "calibration.json";
  if (!std::filesystem::exists(path)) return std::nullopt;
  std::ifstream file(path);
  try {
    return compare(json::parse(file), session, summary);
  } catch (const json::exception& error) {
    throw Corrupt(path.string() + ": " + error.what());
  }
}

}  // namespace lumitexel
