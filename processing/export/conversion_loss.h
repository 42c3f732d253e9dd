// What a conversion changes in the picture: the model and the converted material rendered from six sides under two lights each, the one beside
// the camera (highlights towards the viewer) and one raking, and compared as photographs are (image_error.h). The converted material is
// evaluated from the textures as written, filtered bilinearly, in the mesh's tangent frames.
#pragma once

#include <filesystem>

#include "processing/export/exported_maps.h"
#include "processing/evaluation/image_error.h"
#include "processing/model/render_view.h"

namespace lumitexel {

// Direct light, as ViewRenderer has it. Three channels; the view's light of as many.
Image render_exported(const Model& model, const ExportedMaps& maps, const View& view);

struct ConversionLoss {
  ImageError error;  // of the conversion, the model's own rendering in the photograph's place
  int views = 0;
};
ConversionLoss conversion_loss(const Model& model, const ExportedMaps& maps, Progress& progress);
// The views compared, for looking at them.
std::vector<View> conversion_views(const Mesh& mesh, int channels);
// The model's own rendering of one, antialiased, as EXR: what another program's picture of the export is to be compared with. Throws Error.
void write_reference(const std::filesystem::path& path, const Model& model, const View& view);

}  // namespace lumitexel
