// From samples to materials and the weights of every texel: what a fit does once on the mesh's normals, and once more on fitted ones.
#pragma once

#include <string>
#include <vector>

#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/project_weights.h"
#include "processing/fit/fit_model.h"
#include "processing/surface/atlas.h"

namespace lumitexel {

// The session's reflectances in the middle, 1/sr; 0 if there are none.
double median_reflectance(const Observations& observations);
// The error model on this session's own scale, so that a dark object is not drowned in its floor.
ErrorModel error_model(const Observations& observations, const FitOptions& options);

struct FitInputs {
  const Atlas& atlas;
  const LumitexelSet& lumitexels;
  const Observations& observations;
  const FitOptions& options;
  const ErrorModel& error;
};

// Of each material, as its texels mix them.
std::vector<std::vector<Brdf>> bases_of(const Model& model);

// What the chain from samples to weights leaves, beside the materials in the model.
struct Reflectance {
  Clustering clustering;
  std::vector<TexelWeights> weights, projection;  // projection: before principal function analysis, if that ran
};

// Fills model.materials and model.single. `pass` goes into the names of the stages.
Reflectance fit_reflectance(const FitInputs& inputs, const MaterialsBefore& before, const std::string& pass, Model& model, FitSummary& summary,
                            StageTimer& timer, Progress& progress);

// Moves each material's basis where that pays, and projects once more.
void seek_principal_functions(const FitInputs& inputs, Reflectance& reflectance, Model& model, FitSummary& summary, StageTimer& timer,
                              Progress& progress);

}  // namespace lumitexel
