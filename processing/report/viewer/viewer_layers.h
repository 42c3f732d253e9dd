// Materials and weights of a model as the viewer's page carries them: the final ones and, where normals were fitted, those of the
// stages before (ReflectanceLayer), and which of them a stage of the fit is drawn with.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "processing/model/model.h"
#include "processing/report/viewer/packed_chunks.h"

namespace lumitexel {

// "family", "diffuse", "lobes" by lobe and channel: "log_strength" (null: off), "log_shape", "aim".
nlohmann::json brdf_json(const Brdf& brdf);

// By layer, the final one first: materials, each with "brdf", "basis", "projection_basis" and "colour" (sRGB in [0, 1]).
nlohmann::json layers_json(const Model& model);

// All of kFitStages in their order: "name"; "held" (holds_stage); "layer" (of layers_json); "functions": "single", "cluster",
// "projection" (projection_basis) or "basis"; "texel_normals": false where the mesh's own are used. A stage that the model does not hold
// is as the last one before it.
nlohmann::json stages_json(const Model& model);

// "material_N", "weights_N", "projection_weights_N" of layer N, by the given texels (atlas indices); kNoMaterialCode where a layer has
// no material there. Weights are half floats, a plane a basis BRDF.
inline constexpr std::uint16_t kNoMaterialCode = 65535;
void add_layer_chunks(const Model& model, const std::vector<std::uint32_t>& texels, PackedChunks& chunks);

}  // namespace lumitexel
