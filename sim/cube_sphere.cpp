#include "sim/cube_sphere.h"

#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

// Vertices are named by their integer place on the cube, so that faces share the ones on their edges.
using Place = std::array<int, 3>;

class Builder {
 public:
  explicit Builder(int cells) : cells_(cells), index_(power_of_side(3), kUnseen) {}

  std::uint32_t vertex(const Place& place) {
    std::uint32_t& index =
        index_[static_cast<std::size_t>(place[2]) * power_of_side(2) +
               static_cast<std::size_t>(place[1]) * power_of_side(1) + static_cast<std::size_t>(place[0])];
    if (index == kUnseen) {
      index = static_cast<std::uint32_t>(mesh_.positions.size());
      Eigen::Vector3d x;
      for (int axis = 0; axis < 3; ++axis) {
        const double along = 2.0 * place[static_cast<std::size_t>(axis)] / cells_ - 1.0;
        x[axis] = std::tan(along * std::numbers::pi / 4.0);  // equal angles rather than equal lengths
      }
      mesh_.positions.push_back(x.normalized());
    }
    return index;
  }

  void face(int axis, int side) {
    const auto a = static_cast<std::size_t>(axis), u = (a + 1) % 3, v = (a + 2) % 3;
    for (int i = 0; i < cells_; ++i) {
      for (int j = 0; j < cells_; ++j) {
        std::array<std::uint32_t, 4> corner{};
        for (std::size_t k = 0; k < 4; ++k) {
          Place place{};
          place[a] = side * cells_;
          place[u] = i + (k == 1 || k == 2 ? 1 : 0);
          place[v] = j + (k >= 2 ? 1 : 0);
          corner[k] = vertex(place);
        }
        if (side == 0) std::swap(corner[1], corner[3]);  // seen from outside, the other way round
        mesh_.triangles.push_back({corner[0], corner[1], corner[2]});
        mesh_.triangles.push_back({corner[0], corner[2], corner[3]});
      }
    }
  }

  Mesh take() {
    mesh_.normals = mesh_.positions;
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kUnseen = ~0u;
  std::size_t power_of_side(int exponent) const {
    return exponent == 0 ? 1 : static_cast<std::size_t>(cells_ + 1) * power_of_side(exponent - 1);
  }

  int cells_;
  Mesh mesh_;
  std::vector<std::uint32_t> index_;  // of the vertex at each place of the cube's lattice; its inside stays unused
};

}  // namespace

Mesh cube_sphere(int cells) {
  Builder builder(cells);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) builder.face(axis, side);
  }
  return builder.take();
}

}  // namespace lumitexel
