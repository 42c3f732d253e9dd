// Fits that differ by their calibration alone. A fit makes choices that are whole: into which materials, how many lobes, how much texels
// of a material may differ. They tip for no reason but chance, and each tip moves the held-out error by more than most steps of a
// calibration do. So they are made once an object, and the same for all its calibrations; which texel is of which material, BRDFs and
// weights follow each calibration's samples. The mesh's normals; direct light.
#pragma once

#include <vector>

#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/project_weights.h"
#include "processing/fit/fit_options.h"
#include "processing/model/model.h"

namespace lumitexel {

class SameMaterials {
 public:
  // All choices are made here, on this session. Throws what fit_model throws.
  SameMaterials(const CalibratedSession& reference, const FitOptions& options);
  // Without provenance.
  Model fit(const CalibratedSession& session) const;

 private:
  std::vector<int> labels_of(const Observations& observations) const;

  FitOptions options_;
  Clustering clustering_;
  std::vector<TexelPrior> prior_;  // of each material
};

}  // namespace lumitexel
