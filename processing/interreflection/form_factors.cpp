#include "processing/interreflection/form_factors.h"

#include "processing/brdf/ordered_sum.h"
#include "processing/normals/texel_normal.h"
#include "processing/render/lobe_sampling.h"
#include "processing/render/sample_sequence.h"

namespace lumitexel {
namespace {

constexpr std::uint32_t kDirections = 64;

// By the cosine, as diffuse light leaves.
Eigen::Vector3d above(const Eigen::Vector3d& normal, const TangentFrame& frame, const Eigen::Vector2d& uniform) {
  const Eigen::Vector3d local = LobeSampler().sample(Eigen::Vector3d::UnitZ(), uniform);
  return frame * local.head<2>() + local.z() * normal;
}

bool faces(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& direction) {
  const auto& corner = mesh.triangles[triangle];
  const Eigen::Vector3d& a = mesh.positions[corner[0]];
  return (mesh.positions[corner[1]] - a).cross(mesh.positions[corner[2]] - a).dot(direction) > 0.0;
}

}  // namespace

std::vector<float> facing(const Mesh& mesh, const RayScene& scene, const std::vector<float>& weight) {
  std::vector<float> result(mesh.positions.size(), 0.0f);
  for_each_block(result.size(), [&](std::size_t i) {
    const Eigen::Vector3d& normal = mesh.normals[i];
    if (normal.isZero()) return;
    const TangentFrame frame = tangent_frame(normal);
    const Eigen::Vector3d start = mesh.positions[i] + scene.surface_offset_m() * normal;
    double sum = 0.0;
    for (std::uint32_t k = 0; k < kDirections; ++k) {
      SampleSequence numbers(static_cast<int>(i), 0, 0, k);
      const Eigen::Vector3d direction = above(normal, frame, numbers.next());
      const auto hit = scene.closest(start, direction, scene.surface_offset_m());
      if (hit && faces(mesh, hit->triangle, -direction)) sum += static_cast<double>(weight[hit->triangle]);
    }
    result[i] = static_cast<float>(sum / kDirections);
  });
  return result;
}

}  // namespace lumitexel
