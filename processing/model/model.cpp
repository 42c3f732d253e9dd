#include "processing/model/model.h"

#include "drivers/error.h"

namespace lumitexel {

const char* to_string(FitStage stage) {
  switch (stage) {
    case FitStage::Single: return "single";
    case FitStage::Cluster: return "cluster";
    case FitStage::Projection: return "projection";
    case FitStage::Pfa: return "pfa";
    case FitStage::Normal: return "normal";
  }
  return "unknown";
}

FitStage fit_stage_from_string(const std::string& name) {
  for (const FitStage stage : kFitStages) {
    if (name == to_string(stage)) return stage;
  }
  throw BadInput("stage", "'" + name + "'", "single, cluster, projection, pfa or normal");
}

bool has_principal_functions(const Model& model) {
  return (has_normals(model) ? model.before_normals->projection_weights : model.projection_weights).channels > 0;
}

bool holds_stage(const Model& model, FitStage stage) {
  switch (stage) {
    case FitStage::Single: return true;
    case FitStage::Cluster: return !model.materials.empty();
    case FitStage::Projection: return model.weights.channels > 0;
    case FitStage::Pfa: return has_principal_functions(model);
    case FitStage::Normal: return has_normals(model);
  }
  return false;
}

FitStage last_stage(const Model& model) {
  FitStage last = FitStage::Single;
  for (const FitStage stage : kFitStages) {
    if (holds_stage(model, stage)) last = stage;
  }
  return last;
}

// Stages before normals were fitted to samples as photographed, unless there are no others.
int bounces_taken_out(const Model& model, FitStage stage) {
  return !has_normals(model) || stage == FitStage::Normal ? model.indirect_bounces : 0;
}

LayerAtStage layer_at(const Model& model, FitStage stage) {
  if (has_normals(model) && stage < FitStage::Normal) {
    const ReflectanceLayer& layer = *model.before_normals;
    const bool before = stage < FitStage::Pfa && layer.projection_weights.channels > 0;
    return {layer.materials, layer.material, before ? layer.projection_weights : layer.weights, before};
  }
  const bool before = stage < FitStage::Pfa && model.projection_weights.channels > 0;
  return {model.materials, model.material, before ? model.projection_weights : model.weights, before};
}

double evaluate_texel(const Model& model, FitStage stage, int x, int y, int c, const LobeGeometry& geometry) {
  const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x);
  const LayerAtStage layer = layer_at(model, stage);
  const int material = layer.material[texel];
  if (material == Model::kNoMaterial) return 0.0;
  if (stage == FitStage::Single) return evaluate(model.single, c, geometry);
  const ModelMaterial& chosen = layer.materials[static_cast<std::size_t>(material)];
  if (stage == FitStage::Cluster) return evaluate(chosen.brdf, c, geometry);
  const std::vector<Brdf>& basis = layer.basis_of(chosen);
  double value = 0.0;
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const double weight = layer.weights.at(x, y, static_cast<int>(k));
    if (weight > 0.0) value += weight * evaluate(basis[k], c, geometry);
  }
  return value;
}

}  // namespace lumitexel
