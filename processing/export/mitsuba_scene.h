// A scene for Mitsuba 3 (3.7.1 or later, in an rgb variant): scene.xml with mesh.obj, textures, a point lamp and the first view of the
// conversion's loss (conversion_views); reference.exr beside it is the model's own rendering of that view, in the same unit, as
// `mitsuba -m scalar_rgb scene.xml` should give it. Light is direct, as the reference's.
//
// The material is Mitsuba's form of material_form.h:
//   base.png      reflectance of the diffuse part, sRGB
//   specular.png  specular_reflectance of the highlights, sRGB
//   weight.png    of the highlights against the diffuse part, linear (raw)
//   alpha.exr     of GGX, 32-bit floats (raw): roughness^2
//   normal.png    where the texels' normals are not the mesh's: in each triangle's frame (triangle_frame), (n + 1) / 2, linear (raw)
// principled was not taken: its highlights over a diffuse base have no colour and no F0 above 0.08 but through the base's own colour.
#pragma once

#include <filesystem>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// Into an existing folder; maps in Mitsuba's form. The loss stands in the comment that scene.xml begins with. Throws Error if a file cannot be written.
void write_mitsuba_scene(const std::filesystem::path& directory, const Model& model, const ExportedMaps& maps, const ConversionLoss& loss);

}  // namespace lumitexel
