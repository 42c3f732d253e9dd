// For every triangle the photograph that resolves it best (section 5 of the paper).
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

inline constexpr int kUnseen = -1;

// Indices into session.views, one a triangle of session.mesh; kUnseen where no view that takes part in the fit sees the triangle.
// The best view is the one in which the triangle covers most pixels, among those that see all of it (or, if none
// does, its centre). Where two views are nearly as good, a triangle follows its neighbours, so that patches stay large.
std::vector<int> choose_best_views(const CalibratedSession& session, const RayScene& scene);

}  // namespace lumitexel
