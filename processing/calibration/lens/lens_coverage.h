// Which parts of the picture the calibration boards have been in.
#pragma once

#include <string>
#include <vector>

#include "processing/calibration/lens/landmark.h"

namespace lumitexel {

struct LensCoverage {
  int columns = 8, rows = 6;
  std::vector<int> counts;  // points per cell, row by row
  int at(int column, int row) const { return counts[static_cast<std::size_t>(row * columns + column)]; }
  double share() const;  // of the cells that hold a point
};

LensCoverage lens_coverage(int width_px, int height_px, const std::vector<BoardSighting>& sightings);

// One sentence for each empty corner of the picture, and one if less than half of the cells hold a point: where to put
// the board.
std::vector<std::string> coverage_warnings(const LensCoverage& coverage);

}  // namespace lumitexel
