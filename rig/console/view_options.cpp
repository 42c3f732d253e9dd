#include "rig/console/view_options.h"

#include <charconv>
#include <cmath>
#include <numbers>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr const char* kCameraForm = "\"ex,ey,ez;tx,ty,tz;ux,uy,uz;fov_deg;WIDTHxHEIGHT\"";
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLargestSide_px = 32768;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == separator) {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

double number(const std::string& text, const std::string& where) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw BadInput(where, "'" + text + "'", "a number");
  }
  return value;
}

int side_px(const std::string& text, const std::string& where) {
  const double value = number(text, where);
  if (value < 1 || value > kLargestSide_px || value != std::floor(value)) {
    throw BadInput(where, "'" + text + "'", "a whole number of pixels up to 32768");
  }
  return static_cast<int>(value);
}

struct Target {
  Eigen::Vector3d eye, target, up;
};

Eigen::Isometry3d camera_looking(const Target& look) {
  const Eigen::Vector3d forward = (look.target - look.eye).normalized();
  const Eigen::Vector3d right = forward.cross(look.up).normalized();
  if (!right.allFinite() || right.norm() < 0.5) {
    throw BadInput("--camera", "eye, target and up lie on one line", kCameraForm);
  }
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  world_from_camera.linear() << right, forward.cross(right), forward;
  world_from_camera.translation() = look.eye;
  return world_from_camera.inverse();
}

// `usual`: what stands for no text.
std::vector<double> per_channel(const std::string& text, int channels, double usual, const std::string& option) {
  const auto count = static_cast<std::size_t>(channels);
  if (text.empty()) return std::vector<double>(count, usual);
  const auto parts = split(text, ',');
  if (parts.size() != 1 && parts.size() != count) {
    throw BadInput(option, "'" + text + "'", "one number or " + std::to_string(count));
  }
  std::vector<double> values;
  for (std::size_t c = 0; c < count; ++c) {
    values.push_back(number(parts[parts.size() == 1 ? 0 : c], option));
    if (values.back() < 0.0) throw BadInput(option, "'" + text + "'", "0 or more");
  }
  return values;
}

std::vector<std::string> camera_parts(const std::string& camera) {
  auto parts = split(camera, ';');
  if (parts.size() != 5) throw BadInput("--camera", "'" + camera + "'", kCameraForm);
  return parts;
}

Light point_light(const ViewOptions& options, int channels) {
  if (options.camera.empty() && options.light_intensity.empty()) {
    throw BadInput("--light-intensity", "none, and no --camera whose target it could be made for", "W/sr");
  }
  Light light;
  light.vector_in_world = parse_vector(options.light, "--light");
  double usual = 0.0;
  if (!options.camera.empty()) {
    const Eigen::Vector3d target = parse_vector(camera_parts(options.camera)[1], "--camera target");
    const double distance_m = (light.vector_in_world - target).norm();
    usual = std::numbers::pi * distance_m * distance_m;
  }
  light.intensity = per_channel(options.light_intensity, channels, usual, "--light-intensity");
  return light;
}

Light directional_light(const ViewOptions& options, int channels) {
  Light light;
  light.type = Light::Type::Directional;
  light.vector_in_world = parse_vector(options.directional, "--directional");
  if (!(light.vector_in_world.norm() > 0.0)) throw BadInput("--directional", "no direction", "a vector that is not zero");
  light.vector_in_world.normalize();
  light.intensity = per_channel(options.directional_irradiance, channels, std::numbers::pi, "--directional-irradiance");
  return light;
}

}  // namespace

Eigen::Vector3d parse_vector(const std::string& text, const std::string& where) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) throw BadInput(where, "'" + text + "'", "x,y,z");
  return {number(parts[0], where), number(parts[1], where), number(parts[2], where)};
}

View parse_camera(const ViewOptions& options) {
  const auto parts = camera_parts(options.camera);
  const Target look{parse_vector(parts[0], "--camera eye"), parse_vector(parts[1], "--camera target"),
                    parse_vector(parts[2], "--camera up")};
  const double fov_deg = number(parts[3], "--camera field of view");
  if (!(fov_deg > 0.0 && fov_deg < 180.0))
    throw BadInput("--camera field of view", parts[3], "between 0 and 180 degrees");
  const auto size = split(parts[4], 'x');
  if (size.size() != 2) throw BadInput("--camera size", "'" + parts[4] + "'", "WIDTHxHEIGHT");

  View view;
  view.name = "--camera";
  const int width = side_px(size[0], "--camera width"), height = side_px(size[1], "--camera height");
  const double focal_px = 0.5 * height / std::tan(0.5 * fov_deg * kDegree);
  view.camera = {width, height, focal_px, focal_px, 0.5 * width, 0.5 * height};
  view.camera_from_world = camera_looking(look);
  return view;
}

std::vector<Light> parse_lamps(const ViewOptions& options, int channels) {
  std::vector<Light> lamps;
  if (!options.light.empty()) lamps.push_back(point_light(options, channels));
  if (!options.directional.empty()) lamps.push_back(directional_light(options, channels));
  return lamps;
}

}  // namespace lumitexel
