// A model's normals as other programs take them: for every texel, in world and in the frame of the form (tangent_frame.h).
#pragma once

#include "processing/export/material_form.h"
#include "processing/model/model.h"

namespace lumitexel {

struct ExportedNormals {
  // 3 channels, unit. A texel without a normal of its own has the mesh's, which in the frame is (0, 0, 1); beside the patches the nearest
  // texel's, so that no seam shows when filtered.
  Image world, tangent;
  double tilt_rms_rad = 0;  // of the angle between a texel's normal and the mesh's, over texels with a material
};

// The mesh needs texture coordinates.
ExportedNormals export_normals(const Model& model, MaterialForm form = MaterialForm::Gltf);

// Below this tilt 8 bits do not tell a normal from the mesh's: half a step in each of two components, sqrt(2) / 255.
inline constexpr double kLeastStatedTilt_rad = 0.0056;

}  // namespace lumitexel
