#include "processing/export/obj_file.h"

#include <iomanip>
#include <sstream>

#include "rig/whole_file.h"

namespace lumitexel {

// Positions, texture coordinates and normals share their numbers, which OBJ counts from 1.
void write_obj(const std::filesystem::path& path, const Mesh& mesh) {
  std::ostringstream obj;
  obj << std::setprecision(9);
  for (const Eigen::Vector3d& p : mesh.positions) obj << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Eigen::Vector2d& uv : mesh.texcoords) obj << "vt " << uv.x() << ' ' << uv.y() << '\n';
  for (const Eigen::Vector3d& n : mesh.normals) obj << "vn " << n.x() << ' ' << n.y() << ' ' << n.z() << '\n';
  for (const auto& triangle : mesh.triangles) {
    obj << 'f';
    for (const std::uint32_t vertex : triangle) obj << ' ' << vertex + 1 << '/' << vertex + 1 << '/' << vertex + 1;
    obj << '\n';
  }
  write_whole_file(path, obj.str());
}

}  // namespace lumitexel
