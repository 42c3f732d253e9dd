// Ray casting against one mesh (Embree). Thread-safe once built.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "processing/surface/mesh.h"

namespace lumitexel {

struct RayHit {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;      // barycentric weights of the triangle's second and third vertex
  double distance_m = 0;    // along the unit direction
};

class RayScene {
 public:
  // instruction_set: of the processor, as Embree calls them ("avx2", "avx512"); empty: the widest that it has.
  explicit RayScene(const Mesh& mesh, const std::string& instruction_set = "");
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // First hit from `origin` along the unit `direction`, farther than min_distance_m.
  std::optional<RayHit> closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                double min_distance_m = 0.0) const;
  // Whether anything stands between `from` and `from + direction * max_distance_m` (infinity allowed), beyond
  // min_distance_m from `from`.
  bool occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double min_distance_m,
                double max_distance_m) const;
  // A length that is small against the mesh but large against the rounding of its coordinates (1e-5 of the
  // bounding box's diagonal): the min_distance_m for rays that start on the surface.
  double surface_offset_m() const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace lumitexel
