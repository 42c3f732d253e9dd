// What every step of the search for normals works on.
#pragma once

#include <array>
#include <vector>

#include "processing/normals/directed_samples.h"
#include "processing/normals/lumitexel_neighbours.h"
#include "processing/normals/texel_normal.h"

namespace lumitexel {

struct NormalProblem {
  const DirectedLumitexels& lumitexels;
  const Neighbours& neighbours;
  const std::vector<NormalMaterial>& materials;
  const std::vector<int>& label;  // material of each lumitexel

  const NormalMaterial& material_of(std::size_t lumitexel) const { return materials[static_cast<std::size_t>(label[lumitexel])]; }
};

struct NormalField {
  std::vector<Eigen::Vector3d> normal;  // in world, unit
  std::vector<TexelWeights> weights;
};

// How a deviation of each of a loop's four normals changes the height gained on a way around it: along the sum of the two sides that meet there.
using LoopSides = std::array<Eigen::Vector3d, 4>;

// How far normals may be from where the coarse mesh has them, and from one lumitexel to the next. Normals of a surface have no curl: whoever
// walks around a loop is as high as before.
struct NormalPrior {
  double coarse_sigma_rad = 0.07;     // of the deviation from the coarse mesh's normal, per axis
  double neighbour_sigma_rad = 0.14;  // of the difference between neighbours' deviations, per axis
  double curl_sigma_rad = 0.012;     // of the height gained around a loop over the mean length of its sides

  // Each lumitexel by itself: neither neighbours nor loops count, and the mesh only keeps those without samples where they are.
  static NormalPrior alone() { return {1.0, 1e3, 1e3}; }
};

}  // namespace lumitexel
