#include "processing/calibration/pose/mesh_silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "drivers/error.h"
#include "processing/surface/triangle_adjacency.h"

namespace lumitexel {
namespace {

constexpr double kCreaseCosine = 0.766;  // 40 degrees
constexpr double kOutside_px = 0.3;     // how far outside of the contour nothing may be seen of the mesh

// The cubic patch over a triangle: x at barycentric weights (w, u, v).
Eigen::Vector3d curved_point(const std::array<Eigen::Vector3d, 3>& p, const std::array<Eigen::Vector3d, 3>& n,
                             const Eigen::Vector3d& weights) {
  const double a = weights[0], b = weights[1], c = weights[2];
  const auto towards = [&](std::size_t i, std::size_t j) -> Eigen::Vector3d {  // the control point next to i on edge i, j
    return (2.0 * p[i] + p[j] - (p[j] - p[i]).dot(n[i]) * n[i]) / 3.0;
  };
  const Eigen::Vector3d p01 = towards(0, 1), p10 = towards(1, 0), p12 = towards(1, 2), p21 = towards(2, 1),
                        p20 = towards(2, 0), p02 = towards(0, 2);
  const Eigen::Vector3d edges = (p01 + p10 + p12 + p21 + p20 + p02) / 6.0, corners = (p[0] + p[1] + p[2]) / 3.0;
  const Eigen::Vector3d middle = edges + 0.5 * (edges - corners);
  return a * a * a * p[0] + b * b * b * p[1] + c * c * c * p[2] +
         3.0 * (a * a * b * p01 + a * b * b * p10 + b * b * c * p12 + b * c * c * p21 + c * c * a * p20 + c * a * a * p02) +
         6.0 * a * b * c * middle;
}

std::vector<std::array<Eigen::Vector3d, 3>> split_normals(const Mesh& mesh, const std::vector<Eigen::Vector3d>& facets) {
  std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) around[vertex].push_back(t);
  }
  std::vector<std::array<Eigen::Vector3d, 3>> normals(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const std::uint32_t other : around[mesh.triangles[t][k]]) {
        if (facets[other].normalized().dot(facets[t].normalized()) > kCreaseCosine) sum += facets[other];
      }
      normals[t][k] = sum.normalized();
    }
  }
  return normals;
}

}  // namespace

// Gathers points that the picture shows.
class MeshSilhouette::Collector {
 public:
  Collector(const MeshSilhouette& rims, const CameraModel& camera, const CentredPose& pose, double spacing_px)
      : rims_(rims), camera_(camera), pose_(pose), spacing_px_(spacing_px) {
    eye_ = pose.centre - pose.rotation.transpose() * pose.centre_in_camera;
  }
  const Eigen::Vector3d& eye() const { return eye_; }

  // Points at the middles of equal parts of the piece from `start` to `end`; at(t) is its point, normal_at(t) its normal.
  template <class At, class NormalAt>
  void add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const At& at, const NormalAt& normal_at) {
    const Eigen::Vector3d a = pose_.in_camera(start), b = pose_.in_camera(end);
    if (!(a.z() > 0.0 && b.z() > 0.0)) return;
    const Eigen::Vector2d run = camera_.project(b) - camera_.project(a);
    const double length_px = run.norm();
    if (!(length_px > 1e-9)) return;
    const int parts = std::clamp(static_cast<int>(std::ceil(length_px / spacing_px_)), 1, 10000);
    for (int k = 0; k < parts; ++k) {
      const double t = (k + 0.5) / parts;
      add_point(at(t), normal_at(t), b - a, length_px / parts);
    }
  }
  std::vector<RimPoint> take() { return std::move(points_); }

 private:
  void add_point(const Eigen::Vector3d& x, const Eigen::Vector3d& normal, const Eigen::Vector3d& along, double length_px) {
    const Eigen::Vector3d in_camera = pose_.in_camera(x);
    if (!(in_camera.z() > 0.0)) return;
    const ProjectedPoint projected = project_with_derivatives(camera_, in_camera);
    if (!camera_.contains(projected.pixel)) return;
    const Eigen::Vector2d run = projected.by_point * along;
    const Eigen::Vector2d outwards = projected.by_point * (pose_.rotation * normal);
    Eigen::Vector2d across(run.y(), -run.x());
    if (across.dot(outwards) < 0.0) across = -across;
    across.normalize();
    const double px_per_m = across.dot(outwards);
    if (!(px_per_m > 0.0)) return;
    // Out of the object by a little, and nothing may be met along the whole ray.
    const Eigen::Vector3d aim = x + (kOutside_px / px_per_m) * normal;
    const Eigen::Vector3d direction = (aim - eye_).normalized();
    if (rims_.rays_->occluded(eye_, direction, 0.0, std::numeric_limits<double>::infinity())) return;
    points_.push_back({x, normal, projected.pixel, across, length_px});
  }

  const MeshSilhouette& rims_;
  const CameraModel& camera_;
  const CentredPose& pose_;
  double spacing_px_;
  Eigen::Vector3d eye_;
  std::vector<RimPoint> points_;
};

MeshSilhouette::MeshSilhouette(const Mesh& mesh) : mesh_(mesh), extent_(extent_of(mesh)) {
  if (mesh.triangles.empty() || !std::isfinite(extent_.radius_m) || !extent_.centre.allFinite())
    throw BadInput("mesh", "no triangles, or coordinates that are not finite", "a mesh to be registered");
  for (Eigen::Vector3d& x : mesh_.positions) x -= extent_.centre;  // short numbers, wherever the mesh's origin is
  for (const auto& [a, b, c] : mesh_.triangles) {
    facet_normals_.push_back(
        (mesh_.positions[b] - mesh_.positions[a]).cross(mesh_.positions[c] - mesh_.positions[a]));
  }
  corner_normals_ = split_normals(mesh_, facet_normals_);
  const auto neighbours = triangle_adjacency(mesh_);
  for (std::uint32_t t = 0; t < neighbours.size(); ++t) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t other = neighbours[t][side];
      if (other != kNoNeighbour && other < t) continue;
      const bool sharp = other == kNoNeighbour ||
                         facet_normals_[t].normalized().dot(facet_normals_[other].normalized()) <= kCreaseCosine;
      edges_.push_back({{mesh_.triangles[t][side], mesh_.triangles[t][(side + 1) % 3]}, {t, other}, sharp});
    }
  }
  rays_ = std::make_unique<RayScene>(mesh_);
}

void MeshSilhouette::smooth_outline(Collector& collector) const {
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto& triangle = mesh_.triangles[t];
    const std::array<Eigen::Vector3d, 3>& n = corner_normals_[t];
    std::array<double, 3> facing;
    for (std::size_t k = 0; k < 3; ++k) facing[k] = n[k].dot(mesh_.positions[triangle[k]] - collector.eye());
    if ((facing[0] < 0.0) == (facing[1] < 0.0) && (facing[1] < 0.0) == (facing[2] < 0.0)) continue;
    const std::array<Eigen::Vector3d, 3> p{mesh_.positions[triangle[0]], mesh_.positions[triangle[1]],
                                           mesh_.positions[triangle[2]]};
    std::array<Eigen::Vector3d, 2> ends;
    std::size_t found = 0;
    for (std::size_t k = 0; k < 3 && found < 2; ++k) {
      const std::size_t l = (k + 1) % 3;
      if ((facing[k] < 0.0) == (facing[l] < 0.0)) continue;
      const double share = facing[k] / (facing[k] - facing[l]);
      Eigen::Vector3d weights = Eigen::Vector3d::Zero();
      weights[static_cast<Eigen::Index>(k)] = 1.0 - share;
      weights[static_cast<Eigen::Index>(l)] = share;
      ends[found++] = weights;
    }
    const auto weights_at = [&](double s) -> Eigen::Vector3d { return (1.0 - s) * ends[0] + s * ends[1]; };
    const auto at = [&](double s) { return curved_point(p, n, weights_at(s)); };
    const auto normal_at = [&](double s) -> Eigen::Vector3d {
      const Eigen::Vector3d w = weights_at(s);
      return (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]).normalized();
    };
    collector.add(at(0.0), at(1.0), at, normal_at);
  }
}

void MeshSilhouette::edge_outline(Collector& collector, bool all_edges) const {
  for (const Crease& edge : edges_) {
    if (!all_edges && !edge.sharp) continue;
    const Eigen::Vector3d &a = mesh_.positions[edge.vertices[0]], &b = mesh_.positions[edge.vertices[1]];
    const Eigen::Vector3d view = a - collector.eye();
    const Eigen::Vector3d first = facet_normals_[edge.facets[0]].normalized();
    Eigen::Vector3d normal;
    if (edge.facets[1] == kNoNeighbour) {
      normal = (b - a).cross(first);  // out of the only facet, in its plane
    } else {
      const Eigen::Vector3d second = facet_normals_[edge.facets[1]].normalized();
      if ((first.dot(view) < 0.0) == (second.dot(view) < 0.0)) continue;
      normal = first + second;
    }
    // What stands across edge and view, on the side of the facets' normals.
    const Eigen::Vector3d across = (b - a).cross(view).normalized();
    const double side = across.dot(normal) < 0.0 ? -1.0 : 1.0;
    collector.add(a, b, [&](double s) -> Eigen::Vector3d { return (1.0 - s) * a + s * b; },
                  [&](double) -> Eigen::Vector3d { return side * across; });
  }
}

std::vector<RimPoint> MeshSilhouette::outline(const CameraModel& camera, const CentredPose& pose, double spacing_px,
                                              RimModel model) const {
  CentredPose shifted = pose;  // to the mesh whose centre is its origin
  shifted.centre = pose.centre - extent_.centre;
  Collector collector(*this, camera, shifted, spacing_px);
  if (model == RimModel::Smooth) smooth_outline(collector);
  edge_outline(collector, model == RimModel::Facets);
  std::vector<RimPoint> points = collector.take();
  for (RimPoint& point : points) point.x_in_mesh += extent_.centre;
  return points;
}

}  // namespace lumitexel
