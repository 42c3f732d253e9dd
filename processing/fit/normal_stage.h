// Normals finer than the mesh's (section 9 of the paper), where photographs that the fit leaves out are then predicted better.
#pragma once

#include <string>

#include "processing/fit/reflectance_stage.h"

namespace lumitexel {

struct SoughtNormals {
  std::vector<Eigen::Vector3d> normal;  // of each lumitexel, in world, unit
  std::vector<float> sigma_rad;         // one sigma per tangent axis
  NormalPrior prior;                    // that they were sought under
};

// Whether they are sought, as options say or left-out photographs do; what these said goes into the summary.
bool want_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials, FitSummary& summary, StageTimer& timer,
                  Progress& progress);

// By the model's materials and bases, from the mesh's normals, which inputs.lumitexels must have. sigmas: whether they are wanted; they take
// longer than the normals, and their scale goes into the summary. Without, sigma_rad is the prior's own. `pass` goes into the stage's name.
SoughtNormals find_normals(const CalibratedSession& session, const FitInputs& inputs, const Clustering& materials, const Model& model, bool sigmas,
                           const std::string& pass, FitSummary& summary, StageTimer& timer, Progress& progress);

// What stands in the model so far becomes its stages before normals.
void keep_before_normals(Model& model, FitSummary& summary);
// Texels without a lumitexel have the mesh's normal, which is as good as the prior says.
void set_normal_sigma(const LumitexelSet& lumitexels, const SoughtNormals& normals, Model& model);

}  // namespace lumitexel
