// Where cameras and lights stood around the object, as an inline SVG drawing.
#pragma once

#include <string>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

// Marks of photographs used in the fit and held out.
inline constexpr const char* kFitColour = "#2a5d9c";
inline constexpr const char* kHeldoutColour = "#b4541a";

// Projected along a world axis: horizontal and vertical are the axes (0 x, 1 y, 2 z) drawn to the right and up. Point
// lights stand where they are; a directional light is drawn at the rim, in its direction. Metres, with a scale bar.
std::string plan_drawing(const CalibratedSession& session, int horizontal, int vertical);

}  // namespace lumitexel
