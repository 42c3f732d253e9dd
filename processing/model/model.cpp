#include "processing/model/model.h"

#include "drivers/error.h"

namespace lumitexel {

const char* to_string(FitStage stage) {
  switch (stage) {
    case FitStage::Single: return "single";
    case FitStage::Cluster: return "cluster";
    case FitStage::Projection: return "projection";
    case FitStage::Pfa: return "pfa";
  }
  return "unknown";
}

FitStage fit_stage_from_string(const std::string& name) {
  for (const FitStage stage : kFitStages) {
    if (name == to_string(stage)) return stage;
  }
  throw BadInput("stage", "'" + name + "'", "single, cluster, projection or pfa");
}

double evaluate_texel(const Model& model, FitStage stage, int x, int y, int c, const LobeGeometry& geometry) {
  const auto texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x);
  const int material = model.material[texel];
  if (material == Model::kNoMaterial) return 0.0;
  if (stage == FitStage::Single) return evaluate(model.single, c, geometry);
  const ModelMaterial& chosen = model.materials[static_cast<std::size_t>(material)];
  if (stage == FitStage::Cluster) return evaluate(chosen.brdf, c, geometry);
  const bool before = stage == FitStage::Projection && has_principal_functions(model);
  const std::vector<Brdf>& basis = before ? chosen.projection_basis : chosen.basis;
  const Image& weights = before ? model.projection_weights : model.weights;
  double value = 0.0;
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const double weight = weights.at(x, y, static_cast<int>(k));
    if (weight > 0.0) value += weight * evaluate(basis[k], c, geometry);
  }
  return value;
}

}  // namespace lumitexel
