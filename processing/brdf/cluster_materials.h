// Finds the materials of an object by clustering lumitexels (sections 7.2 to 7.4 of the paper).
#pragma once

#include <functional>
#include <vector>

#include "processing/brdf/fit_lobe.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

struct ClusterOptions {
  int materials = 4;
  std::size_t final_lumitexels = 5000;  // a material's final fit takes at most about so many of its members
  LobeFitOptions fit;
};

struct FittedMaterial {
  LafortuneBrdf brdf;
  Eigen::MatrixXd covariance;   // of its LobeParameters
  std::size_t members = 0;      // lumitexels
};

struct Clustering {
  LafortuneBrdf single;             // one BRDF for everything, where the splitting begins
  std::vector<FittedMaterial> materials;  // fewer than asked for if no split made the fit better
  std::vector<int> label;           // material of every lumitexel; those without samples get the largest material
  int recluster_rounds = 0;
};

// Learns on `selection` (lumitexel indices), then labels all lumitexels and refits on many of each material's. Splits the material
// whose split gains most likelihood: along the first eigenvector of its fit's covariance (eq. 9), along the direction in
// which its lumitexels' brightness and colour vary most, or by parting from those that it explains worst, whichever gains
// most. Reclusters both halves, then all materials (eq. 10), until hardly a label moves any more. report(k) is called with the number of materials so far.
Clustering cluster_materials(const Observations& observations, const std::vector<std::size_t>& selection,
                             const ClusterOptions& options, const std::function<void(int)>& report);

}  // namespace lumitexel
