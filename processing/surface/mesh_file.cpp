#include "processing/surface/mesh_file.h"

#include <algorithm>
#include <bit>
#include <cctype>

#include "drivers/error.h"
#include "processing/surface/mesh_check.h"
#include "processing/surface/obj_reader.h"
#include "processing/surface/ply_reader.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written by copying");

std::string ply_header(const Mesh& mesh) {
  const auto properties = [](std::initializer_list<const char*> names) {
    std::string lines;
    for (const char* name : names) lines += std::string("property double ") + name + "\n";
    return lines;
  };
  return "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex " +
         std::to_string(mesh.positions.size()) + "\n" + properties({"x", "y", "z"}) +
         (mesh.normals.empty() ? "" : properties({"nx", "ny", "nz"})) +
         (mesh.texcoords.empty() ? "" : properties({"s", "t"})) + "element face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
}

template <typename T>
void append(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

}  // namespace

Mesh parse_mesh(std::string_view bytes, const std::string& format, const std::string& where) {
  if (format != ".ply" && format != ".obj") throw BadInput(where, "a mesh of format '" + format + "'", ".ply or .obj");
  ParsedMesh parsed = format == ".ply" ? parse_ply(bytes, where) : parse_obj(bytes, where);
  check_mesh(parsed, where);
  complete_normals(parsed);
  return std::move(parsed.mesh);
}

Mesh read_mesh(const std::filesystem::path& path) {
  std::string format = path.extension().string();
  std::transform(format.begin(), format.end(), format.begin(), [](unsigned char c) { return std::tolower(c); });
  return parse_mesh(read_whole_file(path), format, path.string());
}

std::string encode_ply(const Mesh& mesh) {
  std::string bytes = ply_header(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    append(bytes, mesh.positions[v].data(), 3);
    if (!mesh.normals.empty()) append(bytes, mesh.normals[v].data(), 3);
    if (!mesh.texcoords.empty()) append(bytes, mesh.texcoords[v].data(), 2);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    append(bytes, triangle.data(), 3);
  }
  return bytes;
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) { write_whole_file(path, encode_ply(mesh)); }

}  // namespace lumitexel
