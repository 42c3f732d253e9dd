// The world's parts as solid things, for one angle of the turntable, all in the table's frame: what a ray meets, and
// what stands between a point and a light.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "sim/simulated_world.h"

namespace lumitexel {

enum class ScenePart { Nothing, Object, Sphere, GrayCard, Backlight };

struct SceneHit {
  ScenePart part = ScenePart::Nothing;
  double distance_m = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit; of the object, interpolated between vertices
  Eigen::Vector3d facet = Eigen::Vector3d::Zero();   // unit normal of what the ray really met
};

class PlacedScene {
 public:
  PlacedScene(const SimulatedWorld& world, double turntable_deg);

  const Eigen::Isometry3d& table_from_rig() const { return table_from_rig_; }
  // First part from `origin` along the unit `direction`.
  SceneHit closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  // Whether object, a sphere or the card stands between the hit and the light. The backlight's panel blocks nothing.
  bool shadowed(const SceneHit& hit, const Eigen::Vector3d& light) const;

 private:
  struct Square {
    Eigen::Vector3d centre, right, up, normal;  // unit vectors
    double half_width_m = 0, half_height_m = 0;
    double distance_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  };
  double sphere_distance(std::size_t sphere, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  void complete_object_hit(const RayHit& hit, SceneHit& result) const;

  const SimulatedWorld& world_;
  Eigen::Isometry3d table_from_rig_;
  std::vector<Eigen::Vector3d> spheres_;
  Square card_, panel_;
};

}  // namespace lumitexel
