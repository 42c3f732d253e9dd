// A first camera and first placements, good enough for the least squares to find the rest.
#pragma once

#include <vector>

#include "processing/calibration/lens/reprojection.h"

namespace lumitexel {

// A pinhole with its principal point in the picture's centre. Every board gives a homography (OpenCV); a focal length
// turns it into a pose (Zhang 2000, section 3.1) and the pose's re-projection says how well they agree. Of focal
// lengths from 0.3 to 40 picture widths, 10 % apart, the one with the least median error over the boards is taken: it
// works with a single tilted board, and a few bad boards do not move it.
CameraModel starting_camera(int width_px, int height_px, const std::vector<BoardSighting>& sightings);

// The board's pose by a camera, by OpenCV's two solutions for planes (Collins, Bartoli 2014), the better one refined.
// From far away a plane tilted one way looks nearly as if tilted the other way, so both are tried to the end.
PlacedBoard place_board(const CameraModel& camera, const BoardSighting& sighting);

}  // namespace lumitexel
