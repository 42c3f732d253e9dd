#include "processing/surface/atlas.h"

#include <cmath>
#include <limits>
#include <map>

#include "processing/surface/pack_rectangles.h"
#include "processing/surface/triangle_adjacency.h"

namespace lumitexel {
namespace {

constexpr int kGutterPx = 2;          // around every patch, so that bilinear look-ups stay inside it
constexpr int kSmallestAtlas = 64;
constexpr int kLargestAtlas = 16384;  // what renderers and graphics cards commonly take

struct Box {
  double low_x = std::numeric_limits<double>::infinity(), low_y = low_x;
  double high_x = -low_x, high_y = -low_x;
};

Eigen::Vector2d pixel_of(const View& view, const Eigen::Vector3d& x_in_world) {
  return view.camera.project(view.camera_from_world * x_in_world);
}

// Connected triangles with the same best view get the same patch number.
void grow_patches(const CalibratedSession& session, const std::vector<int>& best_view, Atlas& atlas) {
  const auto adjacency = triangle_adjacency(session.mesh);
  atlas.patch_of_triangle.assign(session.mesh.triangles.size(), -1);
  std::vector<std::uint32_t> open;
  for (std::uint32_t seed = 0; seed < best_view.size(); ++seed) {
    if (best_view[seed] < 0 || atlas.patch_of_triangle[seed] >= 0) continue;
    const int patch = static_cast<int>(atlas.patches.size());
    atlas.patches.push_back({best_view[seed], 0, 0});
    atlas.patch_of_triangle[seed] = patch;
    open.assign(1, seed);
    while (!open.empty()) {
      const std::uint32_t triangle = open.back();
      open.pop_back();
      for (const std::uint32_t next : adjacency[triangle]) {
        if (next == kNoNeighbour || best_view[next] != best_view[seed] || atlas.patch_of_triangle[next] >= 0) continue;
        atlas.patch_of_triangle[next] = patch;
        open.push_back(next);
      }
    }
  }
}

std::vector<Box> patch_boxes(const CalibratedSession& session, const Atlas& atlas) {
  std::vector<Box> boxes(atlas.patches.size());
  for (std::size_t t = 0; t < atlas.patch_of_triangle.size(); ++t) {
    const int patch = atlas.patch_of_triangle[t];
    if (patch < 0) continue;
    const View& view = session.views[static_cast<std::size_t>(atlas.patches[static_cast<std::size_t>(patch)].view)];
    Box& box = boxes[static_cast<std::size_t>(patch)];
    for (const std::uint32_t vertex : session.mesh.triangles[t]) {
      const Eigen::Vector2d pixel = pixel_of(view, session.mesh.positions[vertex]);
      box.low_x = std::min(box.low_x, pixel.x());
      box.low_y = std::min(box.low_y, pixel.y());
      box.high_x = std::max(box.high_x, pixel.x());
      box.high_y = std::max(box.high_y, pixel.y());
    }
  }
  return boxes;
}

void pack_patches(const std::vector<Box>& boxes, Atlas& atlas) {
  std::vector<PackedRectangle> rectangles(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    rectangles[i].width = static_cast<int>(std::ceil(box.high_x) - std::floor(box.low_x)) + 2 * kGutterPx;
    rectangles[i].height = static_cast<int>(std::ceil(box.high_y) - std::floor(box.low_y)) + 2 * kGutterPx;
  }
  constexpr int kReserved = 2 * kGutterPx + 1;  // rows on top, for the texel of unseen triangles
  const PackedSize size = pack_rectangles(rectangles, kSmallestAtlas, kLargestAtlas - kReserved);
  atlas.width = size.width;
  atlas.height = size.height + kReserved;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    atlas.patches[i].shift_x = rectangles[i].x + kGutterPx - static_cast<int>(std::floor(boxes[i].low_x));
    atlas.patches[i].shift_y = rectangles[i].y + kGutterPx + kReserved - static_cast<int>(std::floor(boxes[i].low_y));
  }
}

// Splits vertices where patches meet; every copy gets the texture coordinate of its own patch.
void split_vertices(const CalibratedSession& session, Atlas& atlas) {
  const Mesh& source = session.mesh;
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> copies;
  atlas.mesh.triangles.reserve(source.triangles.size());
  for (std::size_t t = 0; t < source.triangles.size(); ++t) {
    const int patch = atlas.patch_of_triangle[t];
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = source.triangles[t][k];
      const auto [copy, is_new] =
          copies.try_emplace({vertex, patch}, static_cast<std::uint32_t>(atlas.mesh.positions.size()));
      corners[k] = copy->second;
      if (!is_new) continue;
      Eigen::Vector2d texel{0.5, 0.5};
      if (patch >= 0) {
        const AtlasPatch& where = atlas.patches[static_cast<std::size_t>(patch)];
        texel = pixel_of(session.views[static_cast<std::size_t>(where.view)], source.positions[vertex]) +
                Eigen::Vector2d(where.shift_x, where.shift_y);
      }
      atlas.mesh.positions.push_back(source.positions[vertex]);
      atlas.mesh.normals.push_back(source.normals[vertex]);
      atlas.mesh.texcoords.emplace_back(texel.x() / atlas.width, 1.0 - texel.y() / atlas.height);
    }
    atlas.mesh.triangles.push_back(corners);
  }
}

// How far linear texture coordinates miss the picture, at the middles of the triangle's sides and of the whole, in pixels.
double look_up_error(const View& view, const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  constexpr double kThird = 1.0 / 3.0;
  const Eigen::Vector3d places[] = {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {kThird, kThird, kThird}};
  double worst = 0.0;
  for (const Eigen::Vector3d& weight : places) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector2d linear = Eigen::Vector2d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d& corner = mesh.positions[triangle[static_cast<std::size_t>(k)]];
      point += weight[k] * corner;
      linear += weight[k] * pixel_of(view, corner);
    }
    worst = std::max(worst, (pixel_of(view, point) - linear).norm());
  }
  return worst;
}

void move_lumitexels_to_texels(const CalibratedSession& session, Atlas& atlas) {
  atlas.at_texel.assign(session.mesh.triangles.size(), 0);
  bool any = false;
  for (std::size_t t = 0; t < atlas.at_texel.size(); ++t) {
    const int patch = atlas.patch_of_triangle[t];
    if (patch < 0) continue;
    const View& view = session.views[static_cast<std::size_t>(atlas.patches[static_cast<std::size_t>(patch)].view)];
    atlas.at_texel[t] = look_up_error(view, session.mesh, session.mesh.triangles[t]) > kLookUpTolerance;
    any = any || atlas.at_texel[t] != 0;
  }
  if (any) atlas.sites = layout_sites(atlas.mesh, atlas.width, atlas.height, atlas.at_texel).sites;
}

}  // namespace

Atlas make_atlas(const CalibratedSession& session, const std::vector<int>& best_view) {
  Atlas atlas;
  grow_patches(session, best_view, atlas);
  pack_patches(patch_boxes(session, atlas), atlas);
  split_vertices(session, atlas);
  move_lumitexels_to_texels(session, atlas);
  return atlas;
}

}  // namespace lumitexel
