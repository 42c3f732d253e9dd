// The trial that says whether normals are to be fitted (normals_worth.h): on some 40,000 lumitexels, without every fifth photograph.
#pragma once

#include "processing/fit/reflectance_stage.h"

namespace lumitexel {

// bases, label: of the fit on the mesh's normals, which the fitted ones are found with.
NormalsWorth try_normals(const CalibratedSession& session, const FitInputs& inputs, const std::vector<std::vector<Brdf>>& bases,
                         const std::vector<int>& label);

// normals: one a lumitexel, in world.
void turn(const std::vector<Eigen::Vector3d>& normals, LumitexelSet& lumitexels);

}  // namespace lumitexel
