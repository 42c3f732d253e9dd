#include "processing/normals/lumitexel_neighbours.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace lumitexel {
namespace {

constexpr double kDepthEdge = 4.0;    // in spacings: farther apart than this, two adjacent texels lie on two surfaces
constexpr double kAcrossSeam = 1.5;   // in spacings: how far the next patch's lumitexels may be
constexpr double kSameSide = 0.5;     // cosine between normals: the back of a thin wall is no neighbour

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

using ByTexel = std::unordered_map<std::uint32_t, std::uint32_t>;

ByTexel by_texel(const DirectedLumitexels& lumitexels) {
  ByTexel at;
  at.reserve(lumitexels.size());
  for (std::uint32_t i = 0; i < lumitexels.size(); ++i) at.emplace(lumitexels.texel(i), i);
  return at;
}

// Adjacent in the atlas, every pair once; in order of the first.
Pairs atlas_pairs(const DirectedLumitexels& lumitexels, const ByTexel& at, int atlas_width) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < lumitexels.size(); ++i) {
    const std::uint32_t texel = lumitexels.texel(i);
    const auto width = static_cast<std::uint32_t>(atlas_width);
    for (const std::uint32_t next : {texel + 1, texel + width}) {
      if (next == texel + 1 && next % width == 0) continue;
      if (const auto found = at.find(next); found != at.end()) pairs.emplace_back(i, found->second);
    }
  }
  return pairs;
}

double length(const DirectedLumitexels& lumitexels, const std::pair<std::uint32_t, std::uint32_t>& pair) {
  return (lumitexels.position(pair.first) - lumitexels.position(pair.second)).norm();
}

double median_length(const DirectedLumitexels& lumitexels, const Pairs& pairs) {
  std::vector<double> lengths;
  for (const auto& pair : pairs) lengths.push_back(length(lumitexels, pair));
  if (lengths.empty()) return 0.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

// Positions in cells of one edge length, so that the near ones of a point lie in the 27 cells around it.
class PositionGrid {
 public:
  PositionGrid(const DirectedLumitexels& lumitexels, const std::vector<std::uint32_t>& members, double edge_m)
      : lumitexels_(lumitexels), edge_m_(edge_m) {
    for (const std::uint32_t i : members) cells_[key(cell_of(i))].push_back(i);
  }
  template <typename Visit>
  void near(std::uint32_t i, const Visit& visit) const {
    const Eigen::Matrix<std::int64_t, 3, 1> centre = cell_of(i);
    for (int k = 0; k < 27; ++k) {
      const Eigen::Matrix<std::int64_t, 3, 1> cell = centre + Eigen::Matrix<std::int64_t, 3, 1>(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (const auto found = cells_.find(key(cell)); found != cells_.end()) {
        for (const std::uint32_t j : found->second) visit(j);
      }
    }
  }

 private:
  Eigen::Matrix<std::int64_t, 3, 1> cell_of(std::uint32_t i) const {
    return (lumitexels_.position(i) / edge_m_).array().floor().cast<std::int64_t>();
  }
  // Two cells that share a key only cost a look too many.
  static std::uint64_t key(const Eigen::Matrix<std::int64_t, 3, 1>& cell) {
    return static_cast<std::uint64_t>(cell.x()) * 73856093u ^ static_cast<std::uint64_t>(cell.y()) * 19349663u ^
           static_cast<std::uint64_t>(cell.z()) * 83492791u;
  }

  const DirectedLumitexels& lumitexels_;
  double edge_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

// For each lumitexel at a patch's rim, the nearest one of another patch.
Pairs seam_pairs(const DirectedLumitexels& lumitexels, const std::vector<int>& degree, const Pairs& known, double spacing_m) {
  std::vector<std::uint32_t> rim;
  for (std::uint32_t i = 0; i < degree.size(); ++i) {
    if (degree[i] < 4) rim.push_back(i);
  }
  std::unordered_map<std::uint64_t, bool> linked;
  for (const auto& [a, b] : known) linked[static_cast<std::uint64_t>(a) << 32 | b] = true;
  const double reach_m = kAcrossSeam * spacing_m;
  const PositionGrid grid(lumitexels, rim, reach_m);
  Pairs pairs;
  for (const std::uint32_t i : rim) {
    double nearest = reach_m;
    std::uint32_t best = i;
    grid.near(i, [&](std::uint32_t j) {
      const std::uint64_t key = static_cast<std::uint64_t>(std::min(i, j)) << 32 | std::max(i, j);
      if (j == i || linked.contains(key)) return;
      if (lumitexels.coarse_normal(i).dot(lumitexels.coarse_normal(j)) < kSameSide) return;
      const double distance = (lumitexels.position(i) - lumitexels.position(j)).norm();
      if (distance < nearest || (distance == nearest && j < best)) {
        nearest = distance;
        best = j;
      }
    });
    if (best != i) pairs.emplace_back(std::min(i, best), std::max(i, best));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Neighbours by_lumitexel(const Pairs& pairs, std::size_t lumitexels) {
  std::vector<std::vector<std::uint32_t>> lists(lumitexels);
  for (const auto& [a, b] : pairs) {
    lists[a].push_back(b);
    lists[b].push_back(a);
  }
  Neighbours result;
  for (std::vector<std::uint32_t>& list : lists) {
    std::sort(list.begin(), list.end());
    result.other.insert(result.other.end(), list.begin(), list.end());
    result.first.push_back(result.other.size());
  }
  return result;
}

// Loops whose four sides are no depth edges.
std::vector<std::array<std::uint32_t, 4>> atlas_loops(const DirectedLumitexels& lumitexels, const ByTexel& at, int atlas_width,
                                                      double longest_m) {
  std::vector<std::array<std::uint32_t, 4>> loops;
  const auto width = static_cast<std::uint32_t>(atlas_width);
  for (std::uint32_t i = 0; i < lumitexels.size(); ++i) {
    const std::uint32_t texel = lumitexels.texel(i);
    if ((texel + 1) % width == 0) continue;
    std::array<std::uint32_t, 4> loop{i};
    bool whole = true;
    std::size_t k = 1;
    for (const std::uint32_t corner : {texel + 1, texel + width + 1, texel + width}) {
      const auto found = at.find(corner);
      whole = whole && found != at.end();
      if (whole) loop[k++] = found->second;
    }
    for (std::size_t side = 0; whole && side < 4; ++side) {
      whole = length(lumitexels, {loop[side], loop[(side + 1) % 4]}) <= longest_m;
    }
    if (whole) loops.push_back(loop);
  }
  return loops;
}

}  // namespace

Neighbours lumitexel_neighbours(const DirectedLumitexels& lumitexels, int atlas_width) {
  const ByTexel at = by_texel(lumitexels);
  Pairs pairs = atlas_pairs(lumitexels, at, atlas_width);
  const double spacing_m = median_length(lumitexels, pairs);
  std::erase_if(pairs, [&](const auto& pair) { return length(lumitexels, pair) > kDepthEdge * spacing_m; });
  std::vector<int> degree(lumitexels.size(), 0);
  for (const auto& [a, b] : pairs) {
    ++degree[a];
    ++degree[b];
  }
  const Pairs seams = spacing_m > 0.0 ? seam_pairs(lumitexels, degree, pairs, spacing_m) : Pairs{};
  pairs.insert(pairs.end(), seams.begin(), seams.end());
  Neighbours result = by_lumitexel(pairs, lumitexels.size());
  result.loop = atlas_loops(lumitexels, at, atlas_width, kDepthEdge * spacing_m);
  return result;
}

}  // namespace lumitexel
