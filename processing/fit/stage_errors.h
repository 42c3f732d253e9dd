// The paper's Table II: root mean square of predicted minus measured reflectance, after each stage.
#pragma once

#include <vector>

#include "processing/brdf/observations.h"
#include "processing/brdf/project_weights.h"
#include "processing/model/model.h"

namespace lumitexel {

struct StageError {
  double rms = 0;                   // over all samples and channels, 1/sr
  std::vector<double> by_channel;
  std::vector<double> by_material;  // samples of the lumitexels that carry this label
};

// weights: one entry a lumitexel, of the model's basis as it is. label: material of each lumitexel.
StageError stage_error(const Model& model, FitStage stage, const Observations& observations, const std::vector<int>& label,
                       const std::vector<TexelWeights>& weights);

}  // namespace lumitexel
