// A scene for Blender (3.4 or later; 3.4 is what is tested): scene.py, run by `blender --python scene.py`, builds mesh, material, camera and lamp from the files beside it;
// `blender -b --python scene.py -- OUT.exr` renders it with Cycles into linear EXR, in the unit of the model's own rendering, which lies beside it
// as reference.exr, and prints the PSNR between the two. The view is the first of the conversion's loss (conversion_views). Light is direct, as the reference's.
//
// The material is a diffuse shader of base (1 - largest F0) plus, times the specular factor, a metallic Principled shader of colour
// F0 / factor, which is glTF's material but for the diffuse light's fall at grazing angles: a Principled shader alone has no highlights of
// any colour and strength over a diffuse base.
#pragma once

#include <filesystem>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// Into an existing folder. Throws Error if a file cannot be written.
void write_blender_scene(const std::filesystem::path& directory, const Model& model, const RefittedAtlas& atlas, const ExportedMaps& maps,
                         const ConversionLoss& loss);

}  // namespace lumitexel
