// A model's atlas as the textures of glTF's material, as they are written: rounded to 8 bits.
#pragma once

#include "processing/export/gltf_material.h"
#include "processing/model/model.h"
#include "rig/progress.h"

namespace lumitexel {

struct ExportedMaps {
  // In [0, 1], steps of 1/255. Base and specular on the sRGB curve (IEC 61966-2-1, the three channels taken for linear Rec. 709 as the
  // model has them), roughness linear. Texels without a material hold their nearest neighbour's, so that no seam shows when filtered.
  Image base, specular, roughness;  // 3, 3, 1 channels
  double most_f0 = 0;               // what 1 in `specular` stands for
};

// Every texel's mixture is refitted (refit.h). Parallel over rows; the same for any number of threads.
ExportedMaps refit_maps(const Model& model, Progress& progress);

// The inverse of the sRGB curve.
double srgb_decoded(double code);
// What a texel says once decoded.
GltfMaterial decoded_texel(const ExportedMaps& maps, int x, int y);

}  // namespace lumitexel
