// How far to trust the sigmas of fitted normals. They follow from errors that are independent from sample to sample; what is wrong with meshes, poses and
// BRDFs is shared by neighbours. So two fits, each to every second photograph, are compared: they differ by more than the samples' part of
// their sigmas says where that is too small. The prior's part is nearly the same error in both: what is not, since samples of one half determine
// a normal that the other's leave to the mesh, is known from draws of the prior, and counts for nothing.
#pragma once

#include "processing/normals/fit_normals.h"

namespace lumitexel {

// The factor, at least 1, by which the samples' part has to be wider; rms over some 40,000 lumitexels that both fits have three samples of. 1 where there are
// none. What both fits share (the mesh's own error where the prior holds on to it, errors in every photograph) it cannot see.
double normal_sigma_scale(const CalibratedSession& session, const LumitexelSet& lumitexels, int atlas_width,
                          const std::vector<std::vector<Brdf>>& bases, const std::vector<int>& label, double median_reflectance,
                          const NormalFitOptions& options);

// One sigma of a normal per tangent axis, radians: the samples' part so much wider, and the prior's; never over the prior's own, since nobody
// knows less than that.
std::vector<float> widened(const NormalSigmas& sigmas, double scale, const NormalPrior& prior);

}  // namespace lumitexel
