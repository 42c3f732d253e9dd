// What the fit leaves behind: materials, and for every texel of an atlas which material it is and how it mixes
// that material's basis BRDFs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "processing/brdf/brdf_sigma.h"
#include "processing/brdf/error_model.h"
#include "processing/image/image.h"
#include "processing/surface/mesh.h"

namespace lumitexel {

// How far the chain of the paper is followed when the model is evaluated.
enum class FitStage { Single, Cluster, Projection, Pfa, Normal };
inline constexpr FitStage kFitStages[] = {FitStage::Single, FitStage::Cluster, FitStage::Projection, FitStage::Pfa,
                                         FitStage::Normal};
const char* to_string(FitStage stage);  // "single", "cluster", "projection", "pfa", "normal"
FitStage fit_stage_from_string(const std::string& name);  // throws BadInput

struct ModelMaterial {
  Brdf brdf;                // of the cluster
  std::vector<Brdf> basis;  // what its texels mix, weights >= 0
  std::vector<Brdf> projection_basis{};  // as it was before principal function analysis; empty where that did not run
  std::optional<BrdfSigma> sigma{};      // of brdf; nothing in models of before it was kept
  std::optional<ErrorModel> error{};     // that weighed the samples of its texels; nothing in models of before it was kept
};

// Which material every texel is, and how it mixes that material's basis: the maps have the atlas's size.
struct ReflectanceLayer {
  std::vector<ModelMaterial> materials;
  std::vector<std::int16_t> material;
  Image weights, projection_weights;
};

struct Model {
  static constexpr int kNoMaterial = -1;

  int channels = 3;
  Brdf single;  // one BRDF for the whole object
  std::vector<ModelMaterial> materials;
  Mesh mesh;  // with texture coordinates into the atlas, in the session's world

  // The atlas: all maps have this size. Texel (x, y) has its centre at u = (x + 0.5) / width, v = 1 - (y + 0.5) / height.
  int width = 0, height = 0;
  std::vector<std::int16_t> material;  // width * height; kNoMaterial outside the patches
  Image weights;      // channels = largest basis; weight k of the texel's material's basis k
  Image projection_weights;  // the same of projection_basis; no channels where principal function analysis did not run
  Image normal;       // 3 channels, unit, in world; zero where the mesh's own serves
  // The stages before normals were fitted, which go with the mesh's own normals; nothing where they were not.
  std::optional<ReflectanceLayer> before_normals{};
  Image normal_sigma{};  // one-sigma of the fitted normal per tangent axis, radians; 1 channel; empty where they were not fitted
  // Light between the object's own surfaces: after how many bounces it was taken out of the samples that the last stage was fitted to. 0: it was
  // not, and is in the reflectance.
  int indirect_bounces = 0;
  // 2 channels: the most that it could be beside a lamp's light (indirect_bound.h), and what was taken out, as a share of the texel's samples; empty
  // where nobody looked.
  Image indirect{};
  Image uncertainty;  // one-sigma of the texel's reflectance prediction, relative (TexelWeights::relative_sigma); 1 channel
  Image samples;      // number of samples the texel was fitted to; 1 channel; 0 in filled-in texels

  std::string outliers_csv;     // what the model does not explain (outliers.h); empty if nobody looked
  std::string provenance_json;  // an object: version, session hash, options, timings, every stage's error
};

inline bool has_normals(const Model& model) { return model.before_normals.has_value(); }
// Whether principal functions were sought at the stages before normals.
bool has_principal_functions(const Model& model);
bool holds_stage(const Model& model, FitStage stage);
FitStage last_stage(const Model& model);  // of those that it holds
// After how many bounces light between surfaces was taken out of the samples that the stage was fitted to; 0: it is in the reflectance.
int bounces_taken_out(const Model& model, FitStage stage);

// The texels' materials and weights at a stage that goes beyond one BRDF for all: the stages before Normal have a layer of their own
// where normals were fitted. A stage that the model does not hold is as the last one before it.
struct LayerAtStage {
  const std::vector<ModelMaterial>& materials;
  const std::vector<std::int16_t>& material;
  const Image& weights;
  bool projection_basis;  // weights are those of ModelMaterial::projection_basis
  const std::vector<Brdf>& basis_of(const ModelMaterial& m) const { return projection_basis ? m.projection_basis : m.basis; }
};
LayerAtStage layer_at(const Model& model, FitStage stage);

// The BRDF's value f (1/sr) of one texel in channel c, with the stage's share of the model: Normal is all that the model holds. 0 where
// there is no material.
double evaluate_texel(const Model& model, FitStage stage, int x, int y, int c, const LobeGeometry& geometry);

}  // namespace lumitexel
