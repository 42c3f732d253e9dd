// What a picture tells about points of known place on a board: the lens calibration's input, whatever pattern it was.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lumitexel {

// Points that were found together: the four corners of a tag, whose errors are correlated because neighbours share an
// edge, or one corner of a checkerboard.
struct Landmark {
  std::vector<Eigen::Vector3d> x_in_board;  // z = 0
  std::vector<Eigen::Vector2d> pixels;
  Eigen::MatrixXd covariance_px2;  // of x0, y0, x1, y1, …
};

// One placement of a board, photographed once.
struct BoardSighting {
  std::string name;  // of the photograph, for messages
  std::vector<Landmark> landmarks;
  std::size_t points() const {
    std::size_t count = 0;
    for (const Landmark& landmark : landmarks) count += landmark.pixels.size();
    return count;
  }
};

}  // namespace lumitexel
