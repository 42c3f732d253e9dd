#include "processing/report/viewer/viewer_layers.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "processing/report/material_pictures.h"
#include "processing/report/viewer/viewer_model.h"

namespace lumitexel {
namespace {

using nlohmann::json;

constexpr int kFinal = 0, kBeforeNormals = 1;

struct Layer {
  const std::vector<ModelMaterial>& materials;
  const std::vector<std::int16_t>& material;
  const Image &weights, &projection_weights;
};

std::vector<Layer> layers_of(const Model& model) {
  std::vector<Layer> layers{{model.materials, model.material, model.weights, model.projection_weights}};
  if (has_normals(model)) {
    const ReflectanceLayer& before = *model.before_normals;
    layers.push_back({before.materials, before.material, before.weights, before.projection_weights});
  }
  return layers;
}

json lobe_json(const Lobe& lobe) {
  const bool off = !std::isfinite(lobe.log_strength);
  return {{"log_strength", off ? json() : json(lobe.log_strength)}, {"log_shape", lobe.log_shape}, {"aim", lobe.aim}};
}

json basis_json(const std::vector<Brdf>& basis) {
  json list = json::array();
  for (const Brdf& brdf : basis) list.push_back(brdf_json(brdf));
  return list;
}

std::string functions_of(const Model& model, FitStage stage) {
  if (stage == FitStage::Single) return "single";
  if (stage == FitStage::Cluster) return "cluster";
  return layer_at(model, stage).projection_basis ? "projection" : "basis";
}

}  // namespace

json brdf_json(const Brdf& brdf) {
  const auto channels = static_cast<std::size_t>(brdf.channels);
  json lobes = json::array();
  for (const auto& lobe : brdf.lobes) {
    json by_channel = json::array();
    for (std::size_t c = 0; c < channels; ++c) by_channel.push_back(lobe_json(lobe[c]));
    lobes.push_back(by_channel);
  }
  json diffuse = json::array();
  for (std::size_t c = 0; c < channels; ++c) diffuse.push_back(brdf.diffuse[c]);
  return {{"family", to_string(brdf.family)}, {"diffuse", diffuse}, {"lobes", lobes}};
}

json layers_json(const Model& model) {
  json list = json::array();
  for (const Layer& layer : layers_of(model)) {
    json materials = json::array();
    for (std::size_t m = 0; m < layer.materials.size(); ++m) {
      const ModelMaterial& material = layer.materials[m];
      materials.push_back({{"brdf", brdf_json(material.brdf)},
                           {"basis", basis_json(material.basis)},
                           {"projection_basis", basis_json(material.projection_basis)},
                           {"colour", material_colour(static_cast<int>(m))}});
    }
    list.push_back(materials);
  }
  return list;
}

json stages_json(const Model& model) {
  json list = json::array();
  for (const FitStage stage : kFitStages) {
    const bool early = has_normals(model) && stage < FitStage::Normal;
    list.push_back({{"name", to_string(stage)},
                    {"held", holds_stage(model, stage)},
                    {"layer", early ? kBeforeNormals : kFinal},
                    {"functions", functions_of(model, stage)},
                    {"texel_normals", !early}});
  }
  return list;
}

void add_layer_chunks(const Model& model, const std::vector<std::uint32_t>& texels, PackedChunks& chunks) {
  int number = 0;
  for (const Layer& layer : layers_of(model)) {
    const std::string suffix = "_" + std::to_string(number++);
    std::vector<std::uint16_t> material;
    for (const std::uint32_t texel : texels) {
      const std::int16_t of_texel = layer.material[texel];
      material.push_back(of_texel == Model::kNoMaterial ? kNoMaterialCode : static_cast<std::uint16_t>(of_texel));
    }
    chunks.add("material" + suffix, material);
    chunks.add("weights" + suffix, halves_of(layer.weights, texels));
    chunks.add("projection_weights" + suffix, halves_of(layer.projection_weights, texels));
  }
}

}  // namespace lumitexel
