#include "processing/report/material_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "processing/evaluation/image_error.h"

namespace lumitexel {

std::array<float, 3> material_colour(int material) {
  constexpr std::array<std::array<float, 3>, 12> kPalette{{{0.30f, 0.47f, 0.66f},
                                                           {0.95f, 0.56f, 0.17f},
                                                           {0.35f, 0.63f, 0.31f},
                                                           {0.88f, 0.34f, 0.35f},
                                                           {0.46f, 0.72f, 0.70f},
                                                           {0.93f, 0.79f, 0.28f},
                                                           {0.69f, 0.48f, 0.63f},
                                                           {0.61f, 0.46f, 0.37f},
                                                           {1.00f, 0.62f, 0.65f},
                                                           {0.16f, 0.29f, 0.42f},
                                                           {0.62f, 0.78f, 0.44f},
                                                           {0.47f, 0.47f, 0.08f}}};
  constexpr float kRepeatDarkening = 0.7f;
  std::array<float, 3> colour = kPalette[static_cast<std::size_t>(material) % kPalette.size()];
  const auto repeats = static_cast<float>(static_cast<std::size_t>(material) / kPalette.size());
  for (float& value : colour) value *= std::pow(kRepeatDarkening, repeats);
  return colour;
}

Image material_map(const ViewRenderer& renderer, const View& view) {
  constexpr float kUnmeasuredGray = 0.8f;
  const Image material = renderer.render_aov(view, Aov::Cluster);
  const Image normal = renderer.render_aov(view, Aov::Normal), samples = renderer.render_aov(view, Aov::Samples);
  const Eigen::Vector3d towards_camera = view.camera_from_world.inverse().linear().col(2) * -1.0;
  Image shown(material.width, material.height, 3, 1.0f);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const Eigen::Vector3d n(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
      if (n.isZero()) continue;
      const auto shade = static_cast<float>(0.45 + 0.55 * std::max(0.0, n.dot(towards_camera)));
      const bool measured = samples.at(x, y) > 0.0f;  // what borrows its material from beside it has none
      const auto colour = measured ? material_colour(static_cast<int>(material.at(x, y))) : std::array{kUnmeasuredGray, kUnmeasuredGray, kUnmeasuredGray};
      for (int c = 0; c < 3; ++c) shown.at(x, y, c) = shade * colour[static_cast<std::size_t>(c)];
    }
  }
  return shown;
}

Image material_sphere(const Brdf& brdf, int size_px) {
  const Eigen::Vector3d wi = Eigen::Vector3d(-0.4, 0.5, 1.0).normalized(), wo = Eigen::Vector3d::UnitZ();
  Image sphere(size_px, size_px, brdf.channels);
  const double radius_px = 0.5 * size_px - 1.0;
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const double nx = (x + 0.5 - 0.5 * size_px) / radius_px, ny = -(y + 0.5 - 0.5 * size_px) / radius_px;
      const double nz_squared = 1.0 - nx * nx - ny * ny;
      if (nz_squared <= 0.0) continue;
      const LobeGeometry geometry = lobe_geometry({nx, ny, std::sqrt(nz_squared)}, wi, wo);
      for (int c = 0; c < brdf.channels; ++c) {
        const double radiance = std::numbers::pi * evaluate(brdf, c, geometry) * std::max(0.0, geometry.cos_i);
        sphere.at(x, y, c) = static_cast<float>(radiance);
      }
    }
  }
  return sphere;
}

double sphere_white(const std::vector<Image>& spheres) {
  constexpr double kFraction = 0.98;  // highlights of the shiniest may clip, or the dull ones would be black
  double white = 0.0;
  for (const Image& sphere : spheres) {
    std::vector<std::uint8_t> all(sphere.data.size() / static_cast<std::size_t>(sphere.channels), 1);
    white = std::max(white, percentile(sphere, all, kFraction));
  }
  return white > 0.0 ? white : 1.0;
}

}  // namespace lumitexel
