// Normals finer than the mesh's (section 9 of the paper), where photographs that the fit leaves out are then predicted better.
#pragma once

#include <optional>

#include "processing/fit/reflectance_stage.h"

namespace lumitexel {

struct SoughtNormals {
  std::vector<Eigen::Vector3d> normal;  // of each lumitexel, in world, unit
  std::vector<float> sigma_rad;         // one sigma per tangent axis
  NormalPrior prior;                    // that they were sought under
};

// By the model's materials and bases. Nothing where options say so or where left-out photographs do not ask for it; what they said goes into
// the summary.
std::optional<SoughtNormals> seek_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials,
                                          const Model& model, FitSummary& summary, StageTimer& timer, Progress& progress);

// What stands in the model so far becomes its stages before normals.
void keep_before_normals(Model& model, FitSummary& summary);
// Texels without a lumitexel have the mesh's normal, which is as good as the prior says.
void set_normal_sigma(const LumitexelSet& lumitexels, const SoughtNormals& normals, Model& model);

}  // namespace lumitexel
