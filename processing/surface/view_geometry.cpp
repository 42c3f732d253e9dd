#include "processing/surface/view_geometry.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace lumitexel {
namespace {

// A step in depth between neighbouring pixels that is steeper than this slope (against the pixel's footprint) is a
// discontinuity: surfaces tilted by more than about 80 degrees are of no use as samples anyway.
constexpr double kDiscontinuitySlope = 6.0;

struct PixelProbe {
  std::vector<float> distance_m;   // infinity where nothing is hit
  std::vector<Lighting> lighting;
};

void probe_row(const View& view, const Mesh& mesh, const RayScene& scene, int y, ViewGeometry& geometry,
               PixelProbe& probe) {
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  const Eigen::Vector3d eye = world_from_camera.translation();
  for (int x = 0; x < geometry.width; ++x) {
    const std::size_t i = geometry.index(x, y);
    const Eigen::Vector3d direction = world_from_camera.linear() * view.camera.unproject({x + 0.5, y + 0.5});
    const auto hit = scene.closest(eye, direction);
    if (!hit) continue;
    geometry.triangle[i] = hit->triangle;
    geometry.u[i] = static_cast<float>(hit->u);
    geometry.v[i] = static_cast<float>(hit->v);
    probe.distance_m[i] = static_cast<float>(hit->distance_m);
    probe.lighting[i] = lighting_of(view.light, surface_point(mesh, hit->triangle, hit->u, hit->v), scene);
  }
}

// Edges between horizontal and vertical neighbours, put on both pixels.
void mark_edges(const View& view, const PixelProbe& probe, ViewGeometry& geometry) {
  const double footprint = 1.0 / view.camera.focal_x_px;  // of a pixel, at distance one
  const auto compare = [&](std::size_t a, std::size_t b) {
    const float da = probe.distance_m[a], db = probe.distance_m[b];
    const bool miss_a = std::isinf(da), miss_b = std::isinf(db);
    if (miss_a && miss_b) return;
    std::uint8_t flag = 0;
    if (miss_a != miss_b || std::abs(da - db) > kDiscontinuitySlope * footprint * std::min(da, db)) {
      flag |= kViewDepthEdge;
    }
    if (!miss_a && !miss_b && probe.lighting[a] != probe.lighting[b]) flag |= kViewShadowEdge;
    geometry.flags[a] |= flag;
    geometry.flags[b] |= flag;
  };
  for (int y = 0; y < geometry.height; ++y) {
    for (int x = 0; x < geometry.width; ++x) {
      if (x + 1 < geometry.width) compare(geometry.index(x, y), geometry.index(x + 1, y));
      if (y + 1 < geometry.height) compare(geometry.index(x, y), geometry.index(x, y + 1));
    }
  }
}

// Spreads the flags by one pixel in all eight directions.
void dilate(ViewGeometry& geometry) {
  const std::vector<std::uint8_t> before = geometry.flags;
  for (int y = 0; y < geometry.height; ++y) {
    for (int x = 0; x < geometry.width; ++x) {
      std::uint8_t flags = 0;
      for (int ny = std::max(0, y - 1); ny <= std::min(geometry.height - 1, y + 1); ++ny) {
        for (int nx = std::max(0, x - 1); nx <= std::min(geometry.width - 1, x + 1); ++nx) {
          flags |= before[geometry.index(nx, ny)];
        }
      }
      geometry.flags[geometry.index(x, y)] = flags;
    }
  }
}

}  // namespace

SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, double u, double v) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const double w = 1.0 - u - v;
  SurfacePoint point;
  point.position = w * mesh.positions[a] + u * mesh.positions[b] + v * mesh.positions[c];
  point.normal = (w * mesh.normals[a] + u * mesh.normals[b] + v * mesh.normals[c]).normalized();
  return point;
}

bool is_lit(const Light& light, const SurfacePoint& point, const RayScene& scene) {
  const Eigen::Vector3d direction = light.direction_from(point.position);
  if (point.normal.dot(direction) <= 0.0) return false;
  const double reach = light.type == Light::Type::Point ? (light.vector_in_world - point.position).norm()
                                                        : std::numeric_limits<double>::infinity();
  return !scene.occluded(point.position, direction, scene.surface_offset_m(), reach);
}

Lighting lighting_of(const Light& light, const SurfacePoint& point, const RayScene& scene) {
  const bool centre = is_lit(light, point, scene);
  if (light.type != Light::Type::Point || !(light.radius_m > 0.0)) return centre ? Lighting::Full : Lighting::Dark;
  const Eigen::Vector3d across = light.lamp_from_world.row(0), other = light.lamp_from_world.row(1);
  for (int i = 0; i < kRimPlaces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRimPlaces;
    Light place;
    place.vector_in_world = light.vector_in_world + light.radius_m * (std::cos(angle) * across + std::sin(angle) * other);
    if (is_lit(place, point, scene) != centre) return Lighting::Partly;
  }
  return centre ? Lighting::Full : Lighting::Dark;
}

ViewGeometry trace_view(const View& view, const Mesh& mesh, const RayScene& scene) {
  ViewGeometry geometry;
  geometry.width = view.camera.width_px;
  geometry.height = view.camera.height_px;
  const auto count = static_cast<std::size_t>(geometry.width) * static_cast<std::size_t>(geometry.height);
  geometry.triangle.assign(count, ViewGeometry::kNoTriangle);
  geometry.u.assign(count, 0.0f);
  geometry.v.assign(count, 0.0f);
  geometry.flags.assign(count, 0);
  PixelProbe probe{std::vector<float>(count, std::numeric_limits<float>::infinity()),
                   std::vector<Lighting>(count, Lighting::Dark)};
  oneapi::tbb::parallel_for(0, geometry.height,
                            [&](int y) { probe_row(view, mesh, scene, y, geometry, probe); });
  mark_edges(view, probe, geometry);
  for (int step = 1; step < kEdgeMarginPx; ++step) dilate(geometry);
  for (std::size_t i = 0; i < count; ++i) {
    if (geometry.triangle[i] == ViewGeometry::kNoTriangle) geometry.flags[i] |= kViewMiss;
  }
  return geometry;
}

}  // namespace lumitexel
