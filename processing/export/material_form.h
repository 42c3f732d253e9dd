// The forms in which other programs take a refitted material. The numbers are the same (GltfMaterial), what is made of them is not.
//
// Gltf     glTF's own (gltf_material.h); normals in the mesh's interpolated tangent frames.
// Mitsuba  Mitsuba 3's blendbsdf of a diffuse and a roughconductor (distribution ggx, material none, which reflects all) by the weight
//          w = largest f0:
//
//            f = (1 - w) base / pi + f0 D G1 G1 / (4 cos_i cos_o)
//
//          with no Fresnel term, so that highlights cannot rise at grazing angles, and Smith's shadowing of each direction by itself
//          (Walter, Marschner, Li, Torrance 2007, equations 20, 23, 33, 34; the plugins' reference pages). Normals in each triangle's own frame.
#pragma once

#include "processing/export/gltf_material.h"

namespace lumitexel {

enum class MaterialForm { Gltf, Mitsuba };

// What F0 is multiplied with, 1/sr, and (1 - cos_d)^5; zeros if either direction is below the surface.
GltfFacets facets(MaterialForm form, double roughness, const LobeGeometry& geometry);
// f per channel, 1/sr.
ChannelValues evaluate(MaterialForm form, const GltfMaterial& material, const LobeGeometry& geometry);

}  // namespace lumitexel
