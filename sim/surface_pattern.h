// Which material is where on the simulated object: a pattern through space, so that any mesh can wear it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace lumitexel {

inline constexpr int kMaxObjectMaterials = 4;

struct PatternPoint {
  std::array<double, kMaxObjectMaterials> weight{};  // >= 0, sum 1; borders are blended over about 0.5 % of the size
  double albedo_scale = 1.0;                         // texture, in [0.4, 1.2]
  int dominant() const;                              // the material of the largest weight
};

struct SurfacePattern {
  std::uint64_t seed = 1;
  int materials = kMaxObjectMaterials;
  double size_m = 0.16;  // of the object; patches are a quarter of it
  PatternPoint at(const Eigen::Vector3d& x_in_table) const;
};

}  // namespace lumitexel
