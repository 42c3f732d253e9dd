#include "processing/surface/texture_charts.h"

#include <numeric>

namespace lumitexel {

std::vector<std::uint32_t> chart_of_triangle(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> number(parent.size(), kNone), chart;
  std::uint32_t charts = 0;
  for (const auto& triangle : mesh.triangles) {
    std::uint32_t& of_root = number[root(triangle[0])];
    if (of_root == kNone) of_root = charts++;
    chart.push_back(of_root);
  }
  return chart;
}

}  // namespace lumitexel
