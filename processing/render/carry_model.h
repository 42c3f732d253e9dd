// A model's BRDFs and normals put on a mesh that was bent, moved or animated, with the same topology.
#pragma once

#include <string>

#include "processing/model/model.h"

namespace lumitexel {

// `changed` has the model's triangles in the same order, each with its corners in the same order; its vertices may be
// split otherwise (the model's mesh is split where patches of the atlas meet, the scan it came from is not). Positions
// and vertex normals become those of `changed`; texture coordinates and all maps stay, but for the texels' own normals,
// which turn with their triangle:
//
//   n' ~ F^-T n,   F (e1, e2, n0) = (e1', e2', s n0')
//
// for its sides e1, e2, its unit normal n0 and s = sqrt(area' / area), so that what is tilted stays tilted against the
// triangle, rigid motion and scaling keep all angles, and where the triangle is stretched relief is drawn out with it.
// A texel beside all triangles (the atlas's padding) turns with the nearest.
//
// Throws BadInput naming `where` for another number of triangles, corners that one vertex of the model cannot be at
// together, and triangles without area.
Model carried_to(Model model, const Mesh& changed, const std::string& where);

}  // namespace lumitexel
