// A model's atlas as the textures of glTF's material, as they are written: rounded to 8 bits.
#pragma once

#include "processing/export/exported_normals.h"
#include "processing/export/material_form.h"
#include "processing/model/model.h"
#include "rig/progress.h"

namespace lumitexel {

// Before rounding. Texels without a material hold their nearest neighbour's.
struct RefittedAtlas {
  MaterialForm form = MaterialForm::Gltf;
  int width = 0, height = 0;
  std::vector<GltfMaterial> texels;  // row by row
  ExportedNormals normals;
};

struct ExportedMaps {
  MaterialForm form = MaterialForm::Gltf;
  // In [0, 1], steps of 1/255. Base and specular on the sRGB curve (IEC 61966-2-1, the three channels taken for linear Rec. 709 as the
  // model has them), the others linear. Texels without a material hold their nearest neighbour's, so that no seam shows when filtered.
  // F0 = most_share * specular * specular_factor: the small F0 of a highlight that does not rise keeps its digits in `specular`.
  Image base, specular;              // 3 channels
  Image roughness, specular_factor;  // 1 channel
  Image normal;           // 3 channels, (n + 1) / 2 in the tangent frame; no channels where 8 bits would only say that the mesh's normals hold
  double most_share = 0;  // what 1 in `specular` stands for, at most 1; 1 in Mitsuba's form, which cannot multiply
};

// Every texel's mixture is refitted (refit.h). Parallel over rows; the same for any number of threads.
RefittedAtlas refit_atlas(const Model& model, MaterialForm form, Progress& progress);
ExportedMaps textures_of(const RefittedAtlas& atlas);
// Both.
ExportedMaps refit_maps(const Model& model, Progress& progress, MaterialForm form = MaterialForm::Gltf);

// Unit vectors as the 8 bits of a picture, rounded, in [0, 1], and back; not brought to length 1.
Image coded_normals(const Image& normals);
Eigen::Vector3d decoded_normal(const Image& coded, int x, int y);
// The inverse of the sRGB curve.
double srgb_decoded(double code);
// What a texel says once decoded, and its F0 / specular.
GltfMaterial decoded_texel(const ExportedMaps& maps, int x, int y);
std::array<double, 3> decoded_highlight_share(const ExportedMaps& maps, int x, int y);

}  // namespace lumitexel
