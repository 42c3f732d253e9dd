// The observed contour point nearest to a place in the picture, among those whose normals point the same way.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/calibration/pose/silhouette_contour.h"

namespace lumitexel {

class ContourLookup {
 public:
  // Builds distance transforms over a grid of some 512 cells along the picture's longer side, one for each eighth of
  // directions.
  explicit ContourLookup(const SilhouetteContour& contour);

  // Distance to the nearest contour with a normal of the given eighth of directions or beside it, good to a cell or two; large if there is none.
  double distance_px(const Eigen::Vector2d& pixel, std::size_t direction) const;
  std::size_t direction_of(const Eigen::Vector2d& normal) const;
  // The nearest point itself, within reach_px; null if there is none. Exact within a cell's width.
  const ContourPoint* nearest(const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal, double reach_px) const;
  const SilhouetteContour& contour() const { return contour_; }

 private:
  static constexpr int kDirections = 8;
  void build_direction(int direction);
  bool in_grid(int column, int row) const { return column >= 0 && row >= 0 && column < columns_ && row < rows_; }

  SilhouetteContour contour_;  // sorted by cell
  double cell_px_ = 1.0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> first_in_cell_;                          // and one more, the end
  std::vector<float> distance_cells_[kDirections];
  std::vector<std::int32_t> nearest_cell_[kDirections];  // -1: no contour with this direction
};

}  // namespace lumitexel
