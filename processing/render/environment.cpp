#include "processing/render/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "drivers/error.h"
#include "processing/image/exr_file.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;

void check_radiance(const Image& image, const std::string& where) {
  if (image.width < 2 || image.height < 1) {
    throw BadInput(where, std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels", "2x1 or more");
  }
  const auto bad = std::find_if(image.data.begin(), image.data.end(),
                                [](float value) { return !(value >= 0.0f) || !std::isfinite(value); });
  if (bad != image.data.end()) {
    const auto pixel = (bad - image.data.begin()) / image.channels;
    throw BadInput(where,
                   "radiance " + std::to_string(*bad) + " at pixel " + std::to_string(pixel % image.width) + ", " +
                       std::to_string(pixel / image.width),
                   "finite values of 0 or more");
  }
}

// Where `share` falls among the cumulative shares; and how far into that piece, in [0, 1).
struct Piece {
  std::size_t index = 0;
  double inside = 0;
};

Piece piece_at(const double* ends, std::size_t count, double share) {
  const double aim = share * ends[count - 1];
  const auto index = static_cast<std::size_t>(std::min<std::ptrdiff_t>(std::upper_bound(ends, ends + count, aim) - ends,
                                                                       static_cast<std::ptrdiff_t>(count) - 1));
  const double start = index > 0 ? ends[index - 1] : 0.0, size = ends[index] - start;
  return {index, size > 0.0 ? std::clamp((aim - start) / size, 0.0, 1.0) : 0.5};
}

}  // namespace

Environment::Environment(Image radiance, const Eigen::Matrix3d& environment_from_world, const std::string& where)
    : radiance_(std::move(radiance)), environment_from_world_(environment_from_world) {
  check_radiance(radiance_, where);
  const auto width = static_cast<std::size_t>(radiance_.width), height = static_cast<std::size_t>(radiance_.height);
  row_ends_.resize(height);
  column_ends_.resize(height * width);
  for (int y = 0; y < radiance_.height; ++y) {
    double row = 0.0;
    for (int x = 0; x < radiance_.width; ++x) {
      row += brightness(x, y);
      column_ends_[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = row;
    }
    total_ += row * row_solid_angle(y);
    row_ends_[static_cast<std::size_t>(y)] = total_;
  }
  if (!(total_ > 0.0) || !std::isfinite(total_)) {
    throw BadInput(where, total_ > 0.0 ? "radiance too great to be summed" : "no light at all", "some light");
  }
}

double Environment::brightness(int x, int y) const {
  double sum = 0.0;
  for (int c = 0; c < radiance_.channels; ++c) sum += radiance_.at(x, y, c);
  return sum / radiance_.channels;
}

double Environment::row_solid_angle(int y) const {
  const double top = std::cos(kPi * y / radiance_.height), bottom = std::cos(kPi * (y + 1) / radiance_.height);
  return (top - bottom) * 2.0 * kPi / radiance_.width;
}

Environment::Pixel Environment::pixel_at(const Eigen::Vector3d& direction_in_world) const {
  const Eigen::Vector3d d = environment_from_world_ * direction_in_world;
  const double across = 0.5 - std::atan2(d.y(), d.x()) / (2.0 * kPi);
  const double down = std::atan2(std::hypot(d.x(), d.y()), d.z()) / kPi;  // keeps its digits at the poles
  return {std::clamp(static_cast<int>(across * radiance_.width), 0, radiance_.width - 1),
          std::clamp(static_cast<int>(down * radiance_.height), 0, radiance_.height - 1)};
}

double Environment::radiance(const Eigen::Vector3d& direction_in_world, int c) const {
  const Pixel pixel = pixel_at(direction_in_world);
  return radiance_.at(pixel.x, pixel.y, radiance_.channels == 1 ? 0 : c);
}

Eigen::Vector3d Environment::sample(const Eigen::Vector2d& uniform) const {
  const auto width = static_cast<std::size_t>(radiance_.width);
  const Piece row = piece_at(row_ends_.data(), row_ends_.size(), uniform.y());
  const Piece column = piece_at(&column_ends_[row.index * width], width, uniform.x());
  const double rows = radiance_.height, y = static_cast<double>(row.index);
  // Even in the solid angle: in the height on the sphere, and in the longitude.
  const double top = std::cos(kPi * y / rows), bottom = std::cos(kPi * (y + 1.0) / rows);
  const double z = top + row.inside * (bottom - top), level = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double longitude = kPi * (1.0 - 2.0 * (static_cast<double>(column.index) + column.inside) / radiance_.width);
  return environment_from_world_.transpose() *
         Eigen::Vector3d(level * std::cos(longitude), level * std::sin(longitude), z);
}

double Environment::density(const Eigen::Vector3d& direction_in_world) const {
  const Pixel pixel = pixel_at(direction_in_world);
  return brightness(pixel.x, pixel.y) / total_;
}

Eigen::Matrix3d environment_from_world(const Eigen::Vector3d& up_in_world, double turn_rad) {
  if (!(up_in_world.norm() > 0.0)) throw BadInput("environment: up", "no direction", "a vector that is not zero");
  const Eigen::Vector3d up = up_in_world.normalized(), axis = Eigen::Vector3d::UnitZ().cross(up);
  const double angle_rad = std::atan2(axis.norm(), up.z());
  const Eigen::AngleAxisd lift(angle_rad, axis.norm() > 1e-12 ? axis.normalized() : Eigen::Vector3d::UnitX());
  const Eigen::Matrix3d world_from_environment =
      lift.toRotationMatrix() * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return world_from_environment.transpose();
}

Environment read_environment(const std::filesystem::path& path, double scale,
                             const Eigen::Matrix3d& environment_from_world, int channels) {
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    throw BadInput("environment: scale", std::to_string(scale), "a finite number above 0");
  }
  Image image = read_exr_colour(path);
  if (image.channels != 1 && image.channels != channels) {
    throw BadInput(path.string(), std::to_string(image.channels) + " channels",
                   channels == 1 ? "1, as the model has" : "1 or " + std::to_string(channels) + ", as the model has");
  }
  for (float& value : image.data) value = static_cast<float>(value * scale);
  return Environment(std::move(image), environment_from_world, path.string());
}

}  // namespace lumitexel
