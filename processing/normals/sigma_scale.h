// How far to trust the sigmas of fitted normals. They follow from errors that are independent from sample to sample; what is wrong with meshes, poses and
// BRDFs is shared by neighbours. So two fits, each to every second photograph, are compared: they differ by more than their sigmas say
// where sigmas are too small.
#pragma once

#include "processing/normals/fit_normals.h"

namespace lumitexel {

// The factor, at least 1, by which sigmas have to be wider; rms over some 40,000 lumitexels that both fits have three samples of. 1 where there are
// none. What both fits share (the mesh's own error where the prior holds on to it, errors in every photograph) it cannot see.
double normal_sigma_scale(const CalibratedSession& session, const LumitexelSet& lumitexels, int atlas_width,
                          const std::vector<std::vector<Brdf>>& bases, const std::vector<int>& label, double median_reflectance,
                          const NormalFitOptions& options);

}  // namespace lumitexel
