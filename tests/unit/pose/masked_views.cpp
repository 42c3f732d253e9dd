#include "tests/unit/pose/masked_views.h"

#include <cmath>
#include <random>

#include "processing/calibration/pose/centred_pose.h"
#include "sim/cube_sphere.h"
#include "tests/unit/pose/backlit_view.h"

namespace lumitexel {

Mesh unsymmetric_lump() {
  Mesh mesh = cube_sphere(20);
  for (Eigen::Vector3d& x : mesh.positions) {
    const Eigen::Vector3d d = x.normalized();
    const double r = 1.0 + 0.25 * std::sin(2.0 * d.x() + 3.0 * d.y()) + 0.2 * std::cos(3.0 * d.z() - 2.0 * d.x()) + 0.15 * d.y() * d.z();
    x = 0.06 * r * Eigen::Vector3d(1.2 * d.x(), 0.8 * d.y(), d.z());
  }
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

MaskedViews masked_views(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  MaskedViews all{{640, 480, 1900.0, 1900.0, 322.5, 238.5, 0, 0, 0, 0}, {}};
  const RayScene rays(mesh);
  for (std::size_t v = 0; v < count; ++v) {
    MaskedView view;
    view.camera_from_mesh.linear() =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
    view.camera_from_mesh.translation() = Eigen::Vector3d(0.005 * normal(random), 0.005 * normal(random), 1.0 + 0.02 * normal(random)) -
                                          view.camera_from_mesh.linear() * extent_of(mesh).centre;
    const MosaicRadiance picture = backlit_view({mesh, rays, all.camera, view.camera_from_mesh, {}, 0.0, 0.0, 8}, 1);
    for (const float value : picture.value) view.inside.push_back(value < 0.5f);
    all.views.push_back(std::move(view));
  }
  return all;
}

}  // namespace lumitexel
