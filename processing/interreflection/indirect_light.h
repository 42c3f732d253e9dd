// What of each sample is light that came from other surfaces of the object, by a model of it: in the spirit of Nayar, Ikeuchi, Kanade, "Shape
// from interreflections" (1991), with path tracing for the form factors and the model's own BRDFs for the albedos.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

struct IndirectOptions {
  int bounces = 2;    // between the object's surfaces
  int paths = 8;      // a sample; even, half of them in each replicate
};

// As LumitexelTile::reflectance and variance, one entry a tile: what to subtract from each sample (radiance by way of other
// surfaces over the lamp's irradiance, 1/sr), and its variance. Of each sample two replicates are followed that are independent of each other
// (sample_sequence.h) and each well stratified in itself: a quarter of their difference squared is the variance of their mean, rough for a
// sample (one degree of freedom) and right on average. The scatter of single paths is not: in an open bowl it is more than twice as large.
struct IndirectLight {
  std::vector<std::vector<float>> reflectance, variance;
  std::size_t samples = 0;          // that were followed
  std::size_t dropped_paths = 0;    // that were not finite; they count as black
};

// For the lumitexels with wanted[i]; 0 for the others. Light is as the model at `stage` reflects it. The same bits for any number of threads. Throws BadInput on an odd
// number of paths or none.
IndirectLight indirect_light(const CalibratedSession& session, const LumitexelSet& lumitexels, const std::vector<bool>& wanted,
                             const Model& model, FitStage stage, const IndirectOptions& options);

}  // namespace lumitexel
