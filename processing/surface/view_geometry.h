// What one view sees of the coarse mesh, pixel by pixel, and which of its pixels are fit to be sampled.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

// Why a pixel is not to be sampled; bits.
enum ViewPixelFlag : std::uint8_t {
  kViewMiss = 1,        // no surface
  kViewDepthEdge = 2,   // within kEdgeMarginPx of a depth discontinuity or the silhouette
  kViewShadowEdge = 4,  // within kEdgeMarginPx of the border between light and shadow; of a lamp of some size, of its penumbra's borders
};

// Photographs blur over a pixel or two and the coarse mesh is off by as much, so samples closer than this to an
// edge mix two surfaces, or light and shadow.
inline constexpr int kEdgeMarginPx = 2;

struct ViewGeometry {
  static constexpr std::uint32_t kNoTriangle = 0xffffffffu;
  int width = 0, height = 0;
  std::vector<std::uint32_t> triangle;  // seen through the pixel's centre, or kNoTriangle
  std::vector<float> u, v;              // barycentric weights of its second and third vertex
  std::vector<std::uint8_t> flags;      // ViewPixelFlag bits

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// Casts a ray through every pixel centre and shadow rays from every hit (lighting_of). Parallel over rows.
ViewGeometry trace_view(const View& view, const Mesh& mesh, const RayScene& scene);

// Point and unit normal (interpolated between the vertices) at barycentric (u, v) of a triangle.
struct SurfacePoint {
  Eigen::Vector3d position, normal;
};
SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, double u, double v);

// Whether the light's centre reaches the point: in front of the surface and nothing in between.
bool is_lit(const Light& light, const SurfacePoint& point, const RayScene& scene);

// How much of the light's disc reaches the point, by its centre and kRimPlaces places on its rim. A light without a radius, and one
// far away, is Dark or Full as is_lit says, and costs no more.
enum class Lighting : std::uint8_t { Dark, Partly, Full };
inline constexpr int kRimPlaces = 8;
Lighting lighting_of(const Light& light, const SurfacePoint& point, const RayScene& scene);

}  // namespace lumitexel
