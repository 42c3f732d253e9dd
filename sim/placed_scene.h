// The world's parts as solid things, for one angle of the turntable, all in the mesh's frame: what a ray meets, and
// what stands between a point and a light.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "sim/simulated_world.h"

namespace lumitexel {

enum class ScenePart { Nothing, Object, Sphere, GrayCard, Backlight, Tag };

struct SceneHit {
  ScenePart part = ScenePart::Nothing;
  double distance_m = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit; of the object, interpolated between vertices
  Eigen::Vector3d facet = Eigen::Vector3d::Zero();   // unit normal of what the ray really met
  std::size_t tag = 0;                               // which of the rig's, if a tag
};

class PlacedScene {
 public:
  // with_tags: false leaves out the rig's tags.
  PlacedScene(const SimulatedWorld& world, double turntable_deg, bool with_tags = true);

  const Eigen::Isometry3d& mesh_from_rig() const { return mesh_from_rig_; }
  // First part from `origin` along the unit `direction`.
  SceneHit closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  // Whether object, a sphere or the card stands between the hit and the light. The backlight's panel and
  // the tags, which lie on other things, block nothing.
  bool shadowed(const SceneHit& hit, const Eigen::Vector3d& light) const;
  // Of the tag that was hit: the mean over the parallelogram of these two edges about the hit, which lie in the tag's plane.
  double tag_albedo(const SceneHit& hit, const Eigen::Vector3d& across, const Eigen::Vector3d& down) const;

 private:
  struct Square {
    Eigen::Vector3d centre, right, up, normal;  // unit vectors
    double half_width_m = 0, half_height_m = 0;
    double distance_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  };
  Square placed_tag(const TagDescription& tag) const;
  double sphere_distance(std::size_t sphere, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  void complete_object_hit(const RayHit& hit, SceneHit& result) const;

  const SimulatedWorld& world_;
  Eigen::Isometry3d mesh_from_rig_;
  std::vector<Eigen::Vector3d> spheres_;
  Square card_, panel_;
  std::vector<Square> tags_;  // with their margins
};

}  // namespace lumitexel
