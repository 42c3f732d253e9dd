// What the rig sees of a sphere of one known material: the directions of every sample, and samples with noise.
#pragma once

#include <filesystem>
#include <vector>

#include "processing/brdf/nearest_material.h"
#include "processing/brdf/observations.h"
#include "rig/capture_plan.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct SeenSphere {
  std::vector<LobeGeometry> fit;         // by lumitexel, views in the plan's order
  std::vector<std::size_t> first{0};     // of lumitexel i: fit[first[i]] … fit[first[i + 1]]
  std::vector<LobeGeometry> heldout;
};

// A sphere of `radius_m` on the turntable's axis at the pivot's height, `lumitexels` points spread evenly over it. Seen and lit where both
// cosines exceed that of the lumitexels' gathering; held-out ones where they exceed 0.1.
SeenSphere sphere_on_rig(const RigDescription& rig, const CapturePlan& plan, double radius_m, int lumitexels);

struct PhotographNoise {
  double relative = 0.015;  // standard deviation by the signal
  double floor = 2e-4;      // 1/sr
};

// Gaussian noise, each sample and channel for itself, and the variance that the photograph would state for it.
Observations photographed(const BrdfValues& material, const SeenSphere& sphere, const PhotographNoise& noise, unsigned seed);

}  // namespace lumitexel
