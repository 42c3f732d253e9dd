#include "processing/surface/given_layout.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drivers/error.h"
#include "processing/surface/texture_charts.h"

namespace lumitexel {
namespace {

constexpr int kSmallest = 64, kLargest = 16384;
constexpr double kOutside = 1e-6;            // what single precision makes of 0 and 1
constexpr double kFlatTexels = 1e-6;         // square texels: below it a triangle's image is a line
constexpr double kMostFlat = 1e-3, kMostOverlapping = 1e-3;

double twice_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

double layout_area(const Mesh& mesh, std::size_t t) {  // of the unit square; negative where mirrored
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 * twice_area(mesh.texcoords[a], mesh.texcoords[b], mesh.texcoords[c]);
}

double surface_area(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 * (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).norm();
}

struct Fineness {  // of the triangles seen: how many pixels the layout's side would be, and how many pixels say so
  std::vector<std::pair<double, double>> side_and_pixels;
  double at(double share) const {
    double total = 0.0, sum = 0.0;
    for (const auto& [side, pixels] : side_and_pixels) total += pixels;
    for (const auto& [side, pixels] : side_and_pixels) {
      sum += pixels;
      if (sum >= share * total) return side;
    }
    return 0.0;
  }
};

Fineness fineness(const CalibratedSession& session, const std::vector<int>& best_view) {
  Fineness result;
  const Mesh& mesh = session.mesh;
  for (std::size_t t = 0; t < best_view.size(); ++t) {
    const double area = std::abs(layout_area(mesh, t));
    if (best_view[t] < 0 || area <= 0.0) continue;
    const View& view = session.views[static_cast<std::size_t>(best_view[t])];
    std::array<Eigen::Vector2d, 3> pixel;
    for (std::size_t k = 0; k < 3; ++k) pixel[k] = view.camera.project(view.camera_from_world * mesh.positions[mesh.triangles[t][k]]);
    const double pixels = 0.5 * std::abs(twice_area(pixel[0], pixel[1], pixel[2]));
    result.side_and_pixels.emplace_back(std::sqrt(pixels / area), pixels);
  }
  std::sort(result.side_and_pixels.begin(), result.side_and_pixels.end());
  return result;
}

std::size_t shared_texels(const Mesh& mesh, int size, const std::vector<LayoutSite>& sites) {
  const std::vector<std::uint32_t> chart = chart_of_triangle(mesh);
  std::vector<std::uint32_t> owner(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0xffffffffu);
  for (const LayoutSite& site : sites) owner[site.texel] = chart[site.triangle];
  std::vector<std::uint8_t> shared(owner.size(), 0);
  each_texel_read(mesh, size, size, {}, [&](std::uint32_t triangle, std::uint32_t texel) {
    if (owner[texel] != 0xffffffffu && owner[texel] != chart[triangle]) shared[texel] = 1;
  });
  return static_cast<std::size_t>(std::count(shared.begin(), shared.end(), 1));
}

std::string sentence(const char* format, double value, std::size_t count) {
  char text[160];
  std::snprintf(text, sizeof text, format, value, count);
  return text;
}

Atlas atlas_of_mesh(const CalibratedSession& session, const std::vector<int>& best_view, int size) {
  Atlas atlas;
  atlas.width = atlas.height = size;
  atlas.mesh = session.mesh;
  atlas.patch_of_triangle.assign(session.mesh.triangles.size(), -1);
  atlas.at_texel.assign(session.mesh.triangles.size(), 0);
  std::vector<std::uint8_t> unseen(session.mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < best_view.size(); ++t) {
    atlas.at_texel[t] = best_view[t] >= 0;
    unseen[t] = best_view[t] < 0;
  }
  atlas.sites = layout_sites(session.mesh, size, size, atlas.at_texel).sites;
  atlas.unseen_texels.clear();
  for (const LayoutSite& site : layout_sites(session.mesh, size, size, unseen).sites) atlas.unseen_texels.push_back(site.texel);
  return atlas;
}

}  // namespace

const char* to_string(LayoutChoice choice) {
  switch (choice) {
    case LayoutChoice::Auto: return "auto";
    case LayoutChoice::Photographs: return "photographs";
    case LayoutChoice::Mesh: return "mesh";
  }
  return "unknown";
}

int natural_size(const CalibratedSession& session, const std::vector<int>& best_view) {
  return static_cast<int>(std::clamp(std::ceil(fineness(session, best_view).at(0.5)), double{kSmallest}, double{kLargest}));
}

std::string layout_fault(const Mesh& mesh, int size) {
  if (mesh.texcoords.empty()) return "it has no texture coordinates";
  std::size_t outside = 0;
  for (const Eigen::Vector2d& uv : mesh.texcoords) outside += uv.minCoeff() < -kOutside || uv.maxCoeff() > 1.0 + kOutside;
  if (outside > 0) return std::to_string(outside) + " of its texture coordinates lie outside [0, 1]";
  double flat = 0.0, all = 0.0;
  std::size_t flat_triangles = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = surface_area(mesh, t);
    all += area;
    if (std::abs(layout_area(mesh, t)) * size * size >= kFlatTexels) continue;
    flat += area;
    ++flat_triangles;
  }
  if (flat > kMostFlat * all) {
    return sentence("%.2g %% of the surface (%zu triangles) has no area in its layout", 100.0 * flat / all, flat_triangles);
  }
  const LayoutSites sites = layout_sites(mesh, size, size);
  const auto covered = static_cast<double>(sites.sites.size()), contested = static_cast<double>(sites.contested);
  if (contested > kMostOverlapping * covered) {
    return sentence("its charts overlap: %.2g %% of its texels (%zu) belong to two places", 100.0 * contested / covered, sites.contested);
  }
  return "";
}

Atlas lay_out(const CalibratedSession& session, const std::vector<int>& best_view, const LayoutOptions& options, LayoutSummary& summary) {
  summary = {};
  const Mesh& mesh = session.mesh;
  if (options.choice == LayoutChoice::Photographs && options.size > 0) {
    throw BadInput("atlas size", std::to_string(options.size) + " for an atlas cut from the photographs", "the mesh's layout, or no size");
  }
  const bool wanted = options.choice == LayoutChoice::Mesh || (options.choice == LayoutChoice::Auto && !mesh.texcoords.empty());
  if (wanted) {
    const int size = mesh.texcoords.empty() ? kSmallest : options.size > 0 ? options.size : natural_size(session, best_view);
    summary.refused = layout_fault(mesh, size);
    summary.of_mesh = summary.refused.empty();
    if (!summary.of_mesh && options.choice == LayoutChoice::Mesh) {
      throw BadInput("layout of the mesh", summary.refused, "one that gives every point of the surface a place of its own in [0, 1]");
    }
    if (summary.of_mesh) {
      const Fineness fine = fineness(session, best_view);
      constexpr double kShares[] = {0.05, 0.5, 0.95};
      for (std::size_t i = 0; i < 3; ++i) summary.pixels_a_texel[i] = fine.at(kShares[i]) / size;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) summary.mirrored_triangles += layout_area(mesh, t) < 0.0;
      summary.shared_texels = shared_texels(mesh, size, layout_sites(mesh, size, size).sites);
      return atlas_of_mesh(session, best_view, size);
    }
  }
  Atlas atlas = make_atlas(session, best_view);
  summary.lumitexels_at_texels = atlas.sites.size();
  return atlas;
}

}  // namespace lumitexel
