#include "processing/surface/layout_sites.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kOnEdge = 1e-9;      // barycentric: a centre on a shared edge belongs to somebody
constexpr double kWellInside = 1e-6;  // barycentric: beyond what rounding moves an edge
constexpr double kNoArea = 1e-12;     // square texels

struct TexelBox {
  int left, right, top, bottom;
};

// The texels with their centre at most `margin` beside the triangle's bounding box.
TexelBox box_of(const std::array<Eigen::Vector2d, 3>& corner, double margin, int width, int height) {
  const Eigen::Vector2d low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]).array() - margin;
  const Eigen::Vector2d high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]).array() + margin;
  return {std::max(0, static_cast<int>(std::ceil(low.x() - 0.5))), std::min(width - 1, static_cast<int>(std::floor(high.x() - 0.5))),
          std::max(0, static_cast<int>(std::ceil(low.y() - 0.5))), std::min(height - 1, static_cast<int>(std::floor(high.y() - 0.5)))};
}

std::array<Eigen::Vector2d, 3> corners_of(const Mesh& mesh, std::uint32_t triangle, int width, int height) {
  std::array<Eigen::Vector2d, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = texel_of_vertex(mesh, mesh.triangles[triangle][k], width, height);
  return corner;
}

// Whether the box of half a side 1 about the centre, which is what bilinear look-ups of this texel come from, meets the triangle: no side
// of either separates them.
bool reaches(const Eigen::Vector2d& centre, const std::array<Eigen::Vector2d, 3>& corner) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d along = corner[(k + 1) % 3] - corner[k];
    const Eigen::Vector2d across(-along.y(), along.x());
    const double third = across.dot(corner[(k + 2) % 3] - corner[k]);
    const double reach = std::abs(across.x()) + std::abs(across.y());
    const double at = across.dot(centre - corner[k]);
    if (at + reach < std::min(0.0, third) || at - reach > std::max(0.0, third)) return false;
  }
  return true;  // the box's own sides: see box_of
}

template <typename Visit>
void each_wanted(const Mesh& mesh, const std::vector<std::uint8_t>& wanted, const Visit& visit) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (wanted.empty() || wanted[t] != 0) visit(t);
  }
}

}  // namespace

Eigen::Vector2d texel_of_vertex(const Mesh& mesh, std::uint32_t vertex, int width, int height) {
  const Eigen::Vector2d& uv = mesh.texcoords[vertex];
  return {uv.x() * width, (1.0 - uv.y()) * height};
}

LayoutSites layout_sites(const Mesh& mesh, int width, int height, const std::vector<std::uint8_t>& wanted) {
  constexpr std::uint32_t kNobody = 0xffffffffu;
  struct Owner {
    std::uint32_t triangle = kNobody;
    double u = 0, v = 0;
    bool well_inside = false, contested = false;
  };
  std::vector<Owner> owners(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  each_wanted(mesh, wanted, [&](std::uint32_t t) {
    const auto corner = corners_of(mesh, t, width, height);
    Eigen::Matrix2d edges;
    edges << corner[1] - corner[0], corner[2] - corner[0];
    if (std::abs(edges.determinant()) < kNoArea) return;
    const Eigen::Matrix2d inverse = edges.inverse();
    const TexelBox box = box_of(corner, kOnEdge, width, height);
    for (int y = box.top; y <= box.bottom; ++y) {
      for (int x = box.left; x <= box.right; ++x) {
        const Eigen::Vector2d at = inverse * (Eigen::Vector2d(x + 0.5, y + 0.5) - corner[0]);
        const double margin = std::min(at.minCoeff(), 1.0 - at.sum());
        if (margin < -kOnEdge) continue;
        Owner& owner = owners[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        const bool well_inside = margin > kWellInside;
        owner.contested = owner.contested || (well_inside && owner.well_inside);
        owner.well_inside = owner.well_inside || well_inside;
        if (owner.triangle != kNobody) continue;
        owner.triangle = t;
        owner.u = at.x();
        owner.v = at.y();
      }
    }
  });
  LayoutSites result;
  for (std::size_t texel = 0; texel < owners.size(); ++texel) {
    const Owner& owner = owners[texel];
    if (owner.triangle == kNobody) continue;
    result.sites.push_back({static_cast<std::uint32_t>(texel), owner.triangle, owner.u, owner.v});
    result.contested += owner.contested;
  }
  return result;
}

void each_texel_read(const Mesh& mesh, int width, int height, const std::vector<std::uint8_t>& wanted,
                     const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
  each_wanted(mesh, wanted, [&](std::uint32_t t) {
    const auto corner = corners_of(mesh, t, width, height);
    const TexelBox box = box_of(corner, 1.0, width, height);
    for (int y = box.top; y <= box.bottom; ++y) {
      for (int x = box.left; x <= box.right; ++x) {
        if (reaches({x + 0.5, y + 0.5}, corner)) visit(t, static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) + static_cast<std::uint32_t>(x));
      }
    }
  });
}

}  // namespace lumitexel
