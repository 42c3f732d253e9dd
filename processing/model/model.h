// What the fit leaves behind: materials, and for every texel of an atlas which material it is and how it mixes
// that material's basis BRDFs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "processing/brdf/brdf.h"
#include "processing/image/image.h"
#include "processing/surface/mesh.h"

namespace lumitexel {

// How far the chain of the paper is followed when the model is evaluated.
enum class FitStage { Single, Cluster, Projection, Pfa };
inline constexpr FitStage kFitStages[] = {FitStage::Single, FitStage::Cluster, FitStage::Projection, FitStage::Pfa};
const char* to_string(FitStage stage);  // "single", "cluster", "projection", "pfa"
FitStage fit_stage_from_string(const std::string& name);  // throws BadInput

struct ModelMaterial {
  Brdf brdf;                // of the cluster
  std::vector<Brdf> basis;  // what its texels mix, weights >= 0
  std::vector<Brdf> projection_basis{};  // as it was before principal function analysis; empty where that did not run
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
  Image normal;       // 3 channels, unit, in world; zero outside
  Image uncertainty;  // one-sigma of the texel's reflectance prediction, relative; 1 channel
  Image samples;      // number of samples the texel was fitted to; 1 channel; 0 in filled-in texels

  std::string outliers_csv;     // what the model does not explain (outliers.h); empty if nobody looked
  std::string provenance_json;  // an object: version, session hash, options, timings, every stage's error
};

inline bool has_principal_functions(const Model& model) { return model.projection_weights.channels > 0; }

// The BRDF's value f (1/sr) of one texel in channel c, with the stage's share of the model: Pfa is all that the model holds. 0 where there
// is no material.
double evaluate_texel(const Model& model, FitStage stage, int x, int y, int c, const LobeGeometry& geometry);

}  // namespace lumitexel
