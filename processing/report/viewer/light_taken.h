// The light between surfaces that a fit took out of its samples, once more.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

// Takes it out of `set`, the samples as photographed, and adds its variance, as the fit did: by the same paths, and of each lumitexel the very share
// that the model keeps (Model::indirect). Among a lumitexel's samples and channels it is divided as the fit's own model had it, where the finished one
// still holds that: the stages before normals, of a fit that took light once. Else as the finished model has it. What it took, as
// LumitexelTile::reflectance, all tiles in a row; empty where the fit took none.
std::vector<float> take_light_of_fit(const Model& model, const CalibratedSession& session, LumitexelSet& set);

}  // namespace lumitexel
