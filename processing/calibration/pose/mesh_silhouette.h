// The outer contour of a mesh as a camera sees it.
//
// Smooth: the mesh samples a smooth surface. The contour runs where the interpolated vertex normal stands across the view
// (Hertzmann and Zorin, "Illustrating smooth surfaces", 2000, section 4) and is lifted from the facets to the cubic
// patch over each triangle (Vlachos et al., "Curved PN triangles", 2001): a facet's chord lies inside of the surface by
// edge^2 / 8 radius, which at 12 Mpixel is some tenths of a pixel. Where facets meet at more than 40 degrees, the edge is
// a crease and stays one. Facets: the object is the polyhedron itself; the contour is made of its edges.
//
// Only points with nothing of the mesh behind them or in front of them just outside of the contour are kept: a backlit
// picture shows no other.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/pose/centred_pose.h"
#include "processing/surface/mesh.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

enum class RimModel { Smooth, Facets };

struct RimPoint {
  Eigen::Vector3d x_in_mesh, normal_in_mesh;  // of the surface, unit, outwards; across the view
  Eigen::Vector2d pixel, normal;              // of the contour in the picture, unit, outwards
  double length_px = 0;                       // of the contour that this point stands for
};

class MeshSilhouette {
 public:
  // Throws BadInput for a mesh without triangles or with coordinates that are not finite.
  explicit MeshSilhouette(const Mesh& mesh);

  // Points at most spacing_px apart, in the picture or up to its edge. Empty if the mesh reaches behind the camera.
  std::vector<RimPoint> outline(const CameraModel& camera, const CentredPose& pose, double spacing_px,
                                RimModel model) const;
  const MeshExtent& extent() const { return extent_; }

 private:
  struct Crease {
    std::array<std::uint32_t, 2> vertices;
    std::array<std::uint32_t, 2> facets;  // the second is kNoNeighbour at the mesh's border
    bool sharp;
  };
  class Collector;
  void smooth_outline(Collector& collector) const;
  void edge_outline(Collector& collector, bool all_edges) const;

  Mesh mesh_;
  MeshExtent extent_;
  std::vector<Eigen::Vector3d> facet_normals_;
  std::vector<std::array<Eigen::Vector3d, 3>> corner_normals_;
  std::vector<Crease> edges_;
  std::unique_ptr<RayScene> rays_;
};

}  // namespace lumitexel
