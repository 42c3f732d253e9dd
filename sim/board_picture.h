// The radiance of the calibration board as the camera sees it: alone before the dark, lit by the ring flash or the point
// light.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/image/image.h"
#include "sim/simulated_world.h"

namespace lumitexel {

// corner_directions: through the pixels' corners, z = 1, row by row, (width + 1) * (height + 1). A pixel is the mean of the
// printed albedo over its area (144 samples where black and white meet in it) times the irradiance at its middle.
Image board_picture(const SimulatedWorld& world, const WorldState& state,
                    const std::vector<Eigen::Vector3d>& corner_directions);

}  // namespace lumitexel
