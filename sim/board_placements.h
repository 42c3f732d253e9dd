// Where the operator holds the calibration board, and whether it is bent there.
#pragma once

#include <Eigen/Geometry>

#include "sim/simulated_world.h"

namespace lumitexel {

struct BoardPlacement {
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  double bow_m = 0;  // how far its left and right edges are bent towards its printed side: z = bow (x / half width)^2
};

// placement: 1, 2, … The first faces the camera in the picture's middle at the pivot's distance. The others lie in the picture's
// corners, then in its middle and at its edges, and so on, all their squares or tags in the picture, tilted by 10 to 35
// degrees, at 0.7 to 1.1 of that distance (farther if the board is too large for the picture). The same world always gives
// the same. The rig must have a board.
BoardPlacement board_placement(const SimulatedWorld& world, int placement);

}  // namespace lumitexel
