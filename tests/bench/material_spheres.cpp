#include "tests/bench/material_spheres.h"

#include <algorithm>
#include <cmath>

#include "processing/image/tone_map.h"

namespace lumitexel {
namespace {

constexpr double kWhitePercentile = 0.97;  // of the truth's pixels: highlights clip, the body is seen
constexpr int kGap_px = 6;

struct Lamp {
  Eigen::Vector3d towards;
  double strength;
};

Image shaded_sphere(const BrdfValues& material, int size_px) {
  const Lamp lamps[] = {{Eigen::Vector3d(-0.5, 0.6, 0.8).normalized(), 1.0}, {Eigen::Vector3d(0.9, -0.1, -0.35).normalized(), 0.5}};
  Image picture(size_px, size_px, 3);
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const double u = (2.0 * x + 1.0) / size_px - 1.0, v = 1.0 - (2.0 * y + 1.0) / size_px, rest = 1.0 - u * u - v * v;
      if (rest <= 0.0) continue;
      const Eigen::Vector3d normal(u, v, std::sqrt(rest));
      for (const Lamp& lamp : lamps) {
        const LobeGeometry geometry = lobe_geometry(normal, lamp.towards, Eigen::Vector3d::UnitZ());
        if (geometry.cos_i <= 0.0) continue;
        const ChannelValues f = material(geometry);
        for (int c = 0; c < 3; ++c) {
          picture.at(x, y, c) += static_cast<float>(lamp.strength * f[static_cast<std::size_t>(c)] * geometry.cos_i);
        }
      }
    }
  }
  return picture;
}

double white_of(const Image& picture) {
  std::vector<float> values;
  std::copy_if(picture.data.begin(), picture.data.end(), std::back_inserter(values), [](float value) { return value > 0.0f; });
  if (values.empty()) return 1.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kWhitePercentile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

void paste(const Image& from, int left, int top, Image& to) {
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      for (int c = 0; c < 3; ++c) to.at(left + x, top + y, c) = from.at(x, y, c);
    }
  }
}

}  // namespace

Image sphere_sheet(const std::vector<std::pair<BrdfValues, BrdfValues>>& pairs, int columns, int size_px) {
  const int rows = (static_cast<int>(pairs.size()) + columns - 1) / columns, step_x = 2 * size_px + kGap_px, step_y = size_px + kGap_px;
  Image sheet(columns * step_x, std::max(1, rows) * step_y, 3);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Image truth = shaded_sphere(pairs[i].first, size_px), fit = shaded_sphere(pairs[i].second, size_px);
    const double white = white_of(truth);
    const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
    paste(tone_mapped(truth, white), column * step_x, row * step_y, sheet);
    paste(tone_mapped(fit, white), column * step_x + size_px, row * step_y, sheet);
  }
  return sheet;
}

}  // namespace lumitexel
