// A mesh that no photograph shows: mostly one in millimetres, or in another frame than the poses.
#pragma once

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

// Throws BadInput that says how large the mesh is, how far from it the cameras of the fit stand, how many have its middle in their pictures, and what
// to check.
[[noreturn]] void refuse_unseen_mesh(const CalibratedSession& session);

}  // namespace lumitexel
