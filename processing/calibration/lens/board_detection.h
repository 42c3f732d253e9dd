// Where the points of a calibration board appear in a photograph.
#pragma once

#include <optional>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/lens/landmark.h"
#include "processing/image/hdr_merge.h"
#include "rig/rig_description.h"

namespace lumitexel {

// Correspondences in BoardDescription's frame. No landmarks if the board is not found.
//
// Checkerboard: all inner corners or none. Found by OpenCV in an 8-bit picture of at most 1600 pixels' width, then each
// measured in the linear radiance: two straight edges that cross, blurred by a Gaussian,
//   (1 + g . p) (mean + contrast erf(d1 / sqrt2 blur) erf(d2 / sqrt2 blur)),
// d1, d2 the distances from the edges, g the light's falloff. The model is even about the corner, so that the corner
// has no bias though for edges that do not cross at right angles it is an approximation. A board looks the same after
// half a turn (after a quarter, if it has as many columns as rows): the points are then numbered from the other end,
// which is a different pose of the same board. It does not matter to the lens; whoever needs the board's pose itself
// uses tags.
//
// Tag grid: the tags that are seen, four points each; ids outside the board, or seen twice, are left out.
// Their edges bend with the lens's distortion: give the lens if it is known (tag_detection.h).
BoardSighting detect_board(const MosaicRadiance& image, const BoardDescription& board, const std::string& name,
                           const std::optional<CameraModel>& lens = {});

}  // namespace lumitexel
