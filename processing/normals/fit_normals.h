// The normals of a whole object from its materials: the step of section 9 of the paper, for all lumitexels together.
#pragma once

#include <functional>

#include "processing/brdf/cluster_materials.h"
#include "processing/normals/normal_sigmas.h"
#include "processing/normals/smooth_normals.h"

namespace lumitexel {

struct NormalFitOptions {
  NormalPrior prior;
  // Not to the end: what neighbours err by together then passes for their surface (a patch whose photographs err by 15 % in parts ends 1.34
  // of its sigmas off after 40 steps, under 1.25 after these).
  int most_steps = 6;
  // Scale of what is left once the normal is right, as a share of the prediction and of the session's median reflectance. Smaller than the
  // fit of materials has it, which has to make do with the coarse mesh's normals.
  double relative_error = 0.05, floor_share = 0.05;
  TexelPrior texel{1.0, 1.0};  // wide: a texel whose normal is free must not be forced to explain its colour by it
};

struct FittedNormals {
  std::vector<Eigen::Vector3d> normal;  // of each lumitexel, in world, unit
  NormalSigmas sigma;                   // as if samples erred independently: see sigma_scale.h; empty if not wanted
  std::vector<PriorDraw> prior_draws;   // only if wanted
};

// What of a fit beside its normals: sigmas take about as long as they do.
enum class Uncertainty { None, Sigmas, Draws };

// Materials as the search for normals weighs their samples.
std::vector<NormalMaterial> normal_materials(const std::vector<std::vector<Brdf>>& bases, int channels, double median_reflectance,
                                             const NormalFitOptions& options);

std::vector<Eigen::Vector3d> normals_of(const LumitexelSet& lumitexels);
// Gives lumitexels other normals: one each, in world.
void turn(const std::vector<Eigen::Vector3d>& normals, LumitexelSet& lumitexels);

// bases: of each material, as texels mix them. label: material of each lumitexel. median_reflectance: 1/sr.
FittedNormals fit_normals(const DirectedLumitexels& lumitexels, const Neighbours& neighbours, const std::vector<std::vector<Brdf>>& bases,
                          const std::vector<int>& label, double median_reflectance, const NormalFitOptions& options,
                          Uncertainty wanted, const std::function<void(int)>& after_step = [](int) {});

}  // namespace lumitexel
