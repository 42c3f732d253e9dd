// The paper's own way to its materials (sections 7.1 to 7.4), as published, for comparison.
#pragma once

#include <functional>

#include "processing/brdf/cluster_materials.h"

namespace lumitexel {

struct PaperOptions {
  int materials = 4;
  int lobes = 1;                        // 1 to 3, each channel with shapes of its own
  double intensity_weight = 0.3;        // s of eq. 6: what a difference in intensity counts beside one in colour
  std::size_t final_lumitexels = 5000;  // of each material, in the final fit
  int draw = 0;                         // which of them (draw_phase.h)
};

// Fits one BRDF to everything by absolute residuals (eq. 6), then: splits the material of largest total error E_f along the first
// eigenvector of its parameters' covariance (eq. 9), reclusters the halves, then all lumitexels among all materials (eq. 10), until there are
// as many as wanted; labels are hard. At the end all lumitexels are assigned and the fits are repeated with more of them.
Clustering paper_clustering(const Observations& observations, const LumitexelList& selection, const PaperOptions& options,
                            const std::function<void(int)>& report);

}  // namespace lumitexel
