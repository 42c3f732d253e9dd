// A session with fewer photographs to fit: what a shorter capture would have given.
#pragma once

#include <cstddef>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

std::size_t fit_views(const CalibratedSession& session);      // views that are not held out
std::size_t heldout_views(const CalibratedSession& session);

// The session with `kept` of its fit views; held-out views all stay, and the order too. Kept views are spread evenly over
// the directions, from the mesh's middle, of camera and lamp together: beginning with the first fit view, always the one
// whose directions are farthest from those kept so far (farthest-point sampling, Gonzalez 1985; ties go to the earlier
// view). Dropping every second one of the list instead would keep one lamp of two that took turns. So a smaller number
// keeps a subset of what a larger one keeps. Throws BadInput if `kept` is 0 or more than there are.
CalibratedSession with_fit_views(const CalibratedSession& session, std::size_t kept);

}  // namespace lumitexel
