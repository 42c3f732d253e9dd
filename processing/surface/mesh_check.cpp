#include "processing/surface/mesh_check.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "drivers/error.h"

namespace lumitexel {
namespace {

// Well above the rounding of a cross product in double, well below any triangle that a scanner means.
constexpr double kLeastHeight = 1e-12;  // of the longest edge

std::uint32_t position_of(const ParsedMesh& parsed, std::uint32_t vertex) {
  return parsed.position_of_vertex.empty() ? vertex : parsed.position_of_vertex[vertex];
}

std::string place_of_vertex(const ParsedMesh& parsed, const std::string& where, std::size_t vertex) {
  const std::uint32_t position = position_of(parsed, static_cast<std::uint32_t>(vertex));
  return parsed.line_of_position.empty() ? where + ": vertex " + std::to_string(position)
                                         : where + ":" + std::to_string(parsed.line_of_position[position]) + ": vertex";
}

std::string place_of_triangle(const ParsedMesh& parsed, const std::string& where, std::size_t triangle) {
  const std::size_t face = parsed.face_of_triangle.empty() ? triangle : parsed.face_of_triangle[triangle];
  return parsed.line_of_face.empty() ? where + ": face " + std::to_string(face)
                                     : where + ":" + std::to_string(parsed.line_of_face[face]) + ": face";
}

void check_vertices(const ParsedMesh& parsed, const std::string& where) {
  const Mesh& mesh = parsed.mesh;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const bool finite = mesh.positions[v].allFinite() && (mesh.normals.empty() || mesh.normals[v].allFinite()) &&
                        (mesh.texcoords.empty() || mesh.texcoords[v].allFinite());
    if (!finite) throw BadInput(place_of_vertex(parsed, where, v), "NaN or infinite coordinate", "finite numbers");
  }
}

bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[1]] - mesh.positions[triangle[0]];
  const Eigen::Vector3d b = mesh.positions[triangle[2]] - mesh.positions[triangle[0]];
  const double longest_squared = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return a.cross(b).norm() > kLeastHeight * longest_squared;
}

void check_triangles(const ParsedMesh& parsed, const std::string& where) {
  const Mesh& mesh = parsed.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      if (vertex >= mesh.positions.size()) {
        throw BadInput(place_of_triangle(parsed, where, t), "vertex index " + std::to_string(vertex) + " out of range",
                       "less than " + std::to_string(mesh.positions.size()));
      }
    }
    if (!has_area(mesh, mesh.triangles[t])) {
      throw BadInput(place_of_triangle(parsed, where, t), "a triangle with zero area", "three corners not on one line");
    }
  }
}

struct EdgeEnd {
  std::uint32_t to, triangle;
};

// Every edge filed under its lower position, as one array with offsets.
struct EdgeTable {
  std::vector<std::uint32_t> first;
  std::vector<EdgeEnd> ends;

  explicit EdgeTable(const ParsedMesh& parsed) : ends(parsed.mesh.triangles.size() * 3) {
    std::uint32_t positions = 0;
    each_edge(parsed,
              [&](std::uint32_t, std::uint32_t high, std::uint32_t) { positions = std::max(positions, high + 1); });
    first.assign(std::size_t{positions} + 1, 0);
    each_edge(parsed, [&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++first[low + 1]; });
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::uint32_t> next = first;
    each_edge(parsed, [&](std::uint32_t low, std::uint32_t high, std::uint32_t t) { ends[next[low]++] = {high, t}; });
  }

  template <typename Visit>
  static void each_edge(const ParsedMesh& parsed, Visit visit) {
    for (std::uint32_t t = 0; t < parsed.mesh.triangles.size(); ++t) {
      const auto& corners = parsed.mesh.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = position_of(parsed, corners[i]), b = position_of(parsed, corners[(i + 1) % 3]);
        visit(std::min(a, b), std::max(a, b), t);
      }
    }
  }
};

void check_edges(const ParsedMesh& parsed, const std::string& where) {
  EdgeTable table(parsed);
  for (std::size_t low = 0; low + 1 < table.first.size(); ++low) {
    const auto begin = table.ends.begin() + table.first[low], end = table.ends.begin() + table.first[low + 1];
    std::sort(begin, end,
              [](const EdgeEnd& a, const EdgeEnd& b) { return a.to != b.to ? a.to < b.to : a.triangle < b.triangle; });
    for (auto it = begin; end - it > 2; ++it) {
      if (it->to != (it + 2)->to) continue;
      throw BadInput(
          place_of_triangle(parsed, where, (it + 2)->triangle),
          "a third triangle at the edge of vertices " + std::to_string(low) + " and " + std::to_string(it->to),
          "a manifold surface, at most two triangles at an edge");
    }
  }
}

}  // namespace

void check_mesh(const ParsedMesh& parsed, const std::string& where) {
  if (parsed.mesh.triangles.empty()) throw BadInput(where, "a mesh without faces", "at least one triangle");
  check_vertices(parsed, where);
  check_triangles(parsed, where);
  check_edges(parsed, where);
}

void complete_normals(ParsedMesh& parsed) {
  Mesh& mesh = parsed.mesh;
  bool missing = mesh.normals.empty();
  mesh.normals.resize(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (Eigen::Vector3d& normal : mesh.normals) {
    const double length = normal.stableNorm();
    if (length > 0.0) {
      normal /= length;
    } else {
      missing = true;
    }
  }
  if (!missing) return;

  Mesh unsplit;  // the same surface on the file's own positions
  unsplit.positions.resize(parsed.mesh.positions.size(), Eigen::Vector3d::Zero());
  const auto position = [&](std::uint32_t v) { return position_of(parsed, v); };
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (position(v) >= unsplit.positions.size()) unsplit.positions.resize(position(v) + 1, Eigen::Vector3d::Zero());
    unsplit.positions[position(v)] = mesh.positions[v];
  }
  for (const auto& [a, b, c] : mesh.triangles) unsplit.triangles.push_back({position(a), position(b), position(c)});
  const std::vector<Eigen::Vector3d> smooth = vertex_normals(unsplit);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.normals[v].isZero(0.0)) mesh.normals[v] = smooth[position(v)];
  }
}

}  // namespace lumitexel
