#include "processing/surface/wedge_texcoords.h"

#include <cmath>
#include <map>
#include <tuple>

namespace lumitexel {

void split_wedges(const WedgeTexcoords& wedges, ParsedMesh& parsed) {
  const Mesh& given = parsed.mesh;
  for (std::size_t t = 0; t < wedges.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::isnan(wedges[t][k].x()) || given.triangles[t][k] >= given.positions.size()) return;
    }
  }
  Mesh split;
  std::vector<std::uint32_t> position;
  const auto add = [&](std::uint32_t vertex, const Eigen::Vector2d& texcoord) {
    split.positions.push_back(given.positions[vertex]);
    if (!given.normals.empty()) split.normals.push_back(given.normals[vertex]);
    split.texcoords.push_back(texcoord);
    position.push_back(vertex);
  };
  std::map<std::tuple<std::uint32_t, double, double>, std::uint32_t> known;
  std::vector<std::uint8_t> used(given.positions.size(), 0);
  for (std::size_t t = 0; t < wedges.size(); ++t) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = given.triangles[t][k];
      used[vertex] = 1;
      const auto [at, is_new] =
          known.try_emplace({vertex, wedges[t][k].x(), wedges[t][k].y()}, static_cast<std::uint32_t>(split.positions.size()));
      if (is_new) add(vertex, wedges[t][k]);
      corners[k] = at->second;
    }
    split.triangles.push_back(corners);
  }
  for (std::uint32_t vertex = 0; vertex < used.size(); ++vertex) {
    if (used[vertex] == 0) add(vertex, Eigen::Vector2d::Zero());
  }
  parsed.mesh = std::move(split);
  parsed.position_of_vertex = std::move(position);
}

}  // namespace lumitexel
