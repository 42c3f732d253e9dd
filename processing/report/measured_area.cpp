#include "processing/report/measured_area.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kMostParts = 32;

bool measured_at(const Model& model, const Eigen::Vector2d& texcoord) {
  const int x = std::clamp(static_cast<int>(std::floor(texcoord.x() * model.width)), 0, model.width - 1);
  const int y = std::clamp(static_cast<int>(std::floor((1.0 - texcoord.y()) * model.height)), 0, model.height - 1);
  const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x);
  return model.material[texel] != Model::kNoMaterial && model.samples.data[texel] > 0.0f;
}

// Of a triangle by its corners' texture coordinates.
double measured_share(const Model& model, const std::array<Eigen::Vector2d, 3>& corner) {
  const Eigen::Vector2d along = corner[1] - corner[0], across = corner[2] - corner[0];
  const double texels = 0.5 * std::abs(along.x() * across.y() - along.y() * across.x()) * model.width * model.height;
  const int n = static_cast<int>(std::clamp(std::ceil(std::sqrt(texels)), 1.0, kMostParts));
  int measured = 0;
  const auto ask = [&](double a, double b) {
    if (measured_at(model, corner[0] + a / n * along + b / n * across)) ++measured;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      ask(i + 1.0 / 3.0, j + 1.0 / 3.0);
      if (i + j + 1 < n) ask(i + 2.0 / 3.0, j + 2.0 / 3.0);
    }
  }
  return static_cast<double>(measured) / (n * n);
}

}  // namespace

double measured_area_share(const Model& model) {
  const Mesh& mesh = model.mesh;
  if (model.width <= 0 || model.height <= 0 || mesh.texcoords.size() != mesh.positions.size()) return 0.0;
  double area = 0.0, measured = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    const double own = 0.5 * (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).norm();
    area += own;
    measured += own * measured_share(model, {mesh.texcoords[a], mesh.texcoords[b], mesh.texcoords[c]});
  }
  return area > 0.0 ? measured / area : 0.0;
}

}  // namespace lumitexel
