// A model as plain pictures, each as EXR (32-bit floats, as is) and as 8-bit PNG, and maps.json, which says of each what it is:
//
//   base, specular, specular_factor, roughness, metallic   the refitted material (gltf_material.h); specular is F0, metallic 0 everywhere
//   normal_world, normal_tangent             unit vectors; in PNG (n + 1) / 2
//   cluster                                  EXR: the material's index, 65535 where there is none; PNG: the index, 255 where there is none
//   weight_0, …                              of the basis BRDFs of the texel's material
//   uncertainty, samples                     as in the model
//
// maps.json: {"width", "height", "rows": "top first", "texel_centre", "mesh", "conversion_loss", "conversion_loss_of",
// "maps": [{"name", "of": the refitted material, which has the loss, or the model, which has none in EXR, "exr", "png", "what",
// "unit", "exr_colour_space", "png_colour_space", "png_full_scale": what code 255 stands for, "png_zero": what code 0 does}]}. Beside them mesh.ply.
#pragma once

#include <filesystem>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// Into an existing folder. Throws Error if a file cannot be written.
void write_map_files(const std::filesystem::path& directory, const Model& model, const RefittedAtlas& atlas, const ConversionLoss& loss);

}  // namespace lumitexel
