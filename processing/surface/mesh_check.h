// What a mesh has to be before anything is measured on it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "processing/surface/mesh.h"

namespace lumitexel {

// A mesh as a file has it. A vertex of `mesh` is one combination of position, normal and texture coordinate; the same
// position may stand in several of them. A normal of zero is one that the file does not give.
struct ParsedMesh {
  Mesh mesh;
  std::vector<std::uint32_t> position_of_vertex;            // index into the file's positions; empty: one to one
  std::vector<std::uint32_t> face_of_triangle;              // index into the file's faces; empty: one to one
  std::vector<std::size_t> line_of_position, line_of_face;  // from 1; empty for binary files
};

// Throws BadInput naming `where` and the line (or the face or vertex, from 0, of a binary file) for an empty mesh, an
// index out of range, a coordinate that is not finite, a triangle whose height is below 1e-12 of its longest edge, or
// an edge with more than two triangles. Edges are of positions, so a seam of the texture is no border.
void check_mesh(const ParsedMesh& parsed, const std::string& where);

// Makes given normals unit vectors and computes the missing ones from the triangles, smooth across seams of the
// texture.
void complete_normals(ParsedMesh& parsed);

}  // namespace lumitexel
