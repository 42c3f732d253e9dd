#include "sim/loaded_object.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "processing/surface/mesh_file.h"

namespace lumitexel {
namespace {

// A file may hold one vertex several times, once per texture chart; normals and smoothing must not tear there.
Mesh welded(const Mesh& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> index;
  std::vector<std::uint32_t> merged;
  Mesh result;
  for (const Eigen::Vector3d& x : mesh.positions) {
    const auto [found, is_new] =
        index.try_emplace({x.x(), x.y(), x.z()}, static_cast<std::uint32_t>(result.positions.size()));
    if (is_new) result.positions.push_back(x);
    merged.push_back(found->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> triangle{merged[a], merged[b], merged[c]};
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) {
      result.triangles.push_back(triangle);
    }
  }
  return result;
}

std::vector<Eigen::Vector3d> half_way_to_neighbours(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> sum(mesh.positions.size(), Eigen::Vector3d::Zero());
  std::vector<int> count(mesh.positions.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum[triangle[k]] += mesh.positions[triangle[(k + 1) % 3]] + mesh.positions[triangle[(k + 2) % 3]];
      count[triangle[k]] += 2;
    }
  }
  std::vector<Eigen::Vector3d> moved = mesh.positions;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (count[i] > 0) moved[i] = 0.5 * (moved[i] + sum[i] / count[i]);
  }
  return moved;
}

}  // namespace

Mesh loaded_object(const std::filesystem::path& path, bool y_is_up, double size_m,
                   const Eigen::Vector3d& centre_in_table) {
  Mesh mesh = welded(read_mesh(path));
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Eigen::Vector3d& position : mesh.positions) {
    if (y_is_up) position = Eigen::Vector3d(position.z(), position.x(), position.y());
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  const double scale = size_m / (high - low).maxCoeff();
  for (Eigen::Vector3d& position : mesh.positions) {
    position = centre_in_table + scale * (position - 0.5 * (low + high));
  }
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

Mesh smoothed(const Mesh& mesh, double deviation_rms_m) {
  constexpr int kMaxRounds = 200;
  Mesh result = mesh;
  double rms = 0.0;
  for (int round = 0; round < kMaxRounds && rms < deviation_rms_m; ++round) {
    result.positions = half_way_to_neighbours(result);
    double square_sum = 0.0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const double off = (result.positions[i] - mesh.positions[i]).dot(mesh.normals[i]);
      square_sum += off * off;
    }
    rms = std::sqrt(square_sum / static_cast<double>(mesh.positions.size()));
  }
  result.normals = vertex_normals(result);
  return result;
}

}  // namespace lumitexel
