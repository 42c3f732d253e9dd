// The frame in which a tangent-space normal map states its normals.
//
// A vertex's tangent is the mean, weighted by the corner's angle, of its triangles' directions of growing u, each put into the vertex's
// tangent plane: MikkTSpace's rule (Mikkelsen 2008), for vertices that are split where texture coordinates or normals are. Triangles of
// opposite handedness that share a vertex are not told apart: the larger angle decides. In a triangle the normal and the tangent are interpolated and
// brought to length 1, and the bitangent is handedness * cross(normal, tangent), towards growing v, which is up in the picture
// (glTF 2.0, section 3.7.2.1; normal textures with green up, 3.9.3).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/surface/mesh.h"

namespace lumitexel {

// xyz unit and perpendicular to the vertex's normal, w the handedness, 1 or -1. A vertex whose triangles have no area in the texture gets any such
// tangent. The mesh needs texture coordinates.
std::vector<Eigen::Vector4d> vertex_tangents(const Mesh& mesh);

// Columns tangent, bitangent, normal, in world, at the triangle's barycentric weights u, v of its second and third corner.
Eigen::Matrix3d tangent_frame(const Mesh& mesh, const std::vector<Eigen::Vector4d>& tangents, std::uint32_t triangle, double u, double v);

// The frame that Mitsuba 3 shades in: the interpolated normal, the triangle's own direction of growing u in its plane, and
// cross(normal, that), whatever the handedness. Any such frame for a triangle without area in the texture.
Eigen::Matrix3d triangle_frame(const Mesh& mesh, std::uint32_t triangle, double u, double v);

// A world normal in a frame, unit; one that looks below the frame's horizon is laid on it: a texture holds no others.
Eigen::Vector3d in_frame(const Eigen::Matrix3d& frame, const Eigen::Vector3d& normal_in_world);

}  // namespace lumitexel
