#include "tests/unit/surface/unwrapped_cube.h"

namespace lumitexel {

Mesh unwrapped_cube(double side_m, double gutter) {
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1.0 : -1.0;
    Eigen::Vector3d out = Eigen::Vector3d::Zero(), right = out, up = out;
    out[axis] = sign;
    right[(axis + 1) % 3] = sign;
    up[(axis + 2) % 3] = 1.0;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 4; ++corner) {
      const double a = corner == 1 || corner == 2 ? 1.0 : 0.0, b = corner >= 2 ? 1.0 : 0.0;
      mesh.positions.push_back(0.5 * side_m * (out + (2 * a - 1) * right + (2 * b - 1) * up));
      mesh.normals.push_back(out);
      const double left = (face % 3) / 3.0 + gutter, bottom = (face / 3) / 2.0 + gutter;
      mesh.texcoords.emplace_back(left + a * (1.0 / 3.0 - 2 * gutter), bottom + b * (0.5 - 2 * gutter));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

}  // namespace lumitexel
