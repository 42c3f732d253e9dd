// What is printed on the calibration board and on the tags, as a diffuse albedo over the plane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <vector>

#include "rig/rig_description.h"

namespace lumitexel {

inline constexpr double kPrintedBlack = 0.04, kTagWhite = 0.8;

// A tag of the family tag36h11 with its white margin of one cell: ten by ten cells, eight of them across size_m.
class TagPattern {
 public:
  TagPattern() = default;
  explicit TagPattern(int id);  // 0 … 586
  // At a place in tag sizes (TagDescription::size_m) from the centre, x right and y up as printed; outside the margin: white.
  bool white_at(const Eigen::Vector2d& place) const;

  static constexpr int kCells = 10;
  static constexpr double kHalfExtent = 0.625;  // of the margin's edge, in tag sizes

 private:
  std::bitset<kCells * kCells> white_;  // row by row from the top
};

// The board as BoardDescription says, with a white margin of one pitch around a checkerboard's squares, the lower left one
// of which is black.
class BoardPattern {
 public:
  explicit BoardPattern(const BoardDescription& board);
  // At a place in the board's frame, metres; 0 beyond its edge.
  double albedo_at(const Eigen::Vector2d& place_m) const;
  const Eigen::Vector2d& half_size_m() const { return half_size_m_; }

 private:
  BoardDescription board_;
  Eigen::Vector2d half_size_m_;
  std::vector<TagPattern> tags_;
};

}  // namespace lumitexel
