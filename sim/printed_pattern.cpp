#include "sim/printed_pattern.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <cmath>
#include <cstdlib>
#include <memory>

namespace lumitexel {
namespace {

// As image_u8_destroy, which the library keeps to itself.
void release(image_u8_t* image) {
  std::free(image->buf);
  std::free(image);
}

}  // namespace

TagPattern::TagPattern(int id) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(), tag36h11_destroy);
  const std::unique_ptr<image_u8_t, void (*)(image_u8_t*)> image(apriltag_to_image(family.get(), id), release);
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      white_[static_cast<std::size_t>(y * kCells + x)] = image->buf[y * image->stride + x] > 127;
    }
  }
}

bool TagPattern::white_at(const Eigen::Vector2d& place) const {
  const double x = (place.x() / (2.0 * kHalfExtent) + 0.5) * kCells, y = (0.5 - place.y() / (2.0 * kHalfExtent)) * kCells;
  if (!(x >= 0.0 && y >= 0.0 && x < kCells && y < kCells)) return true;
  return white_[static_cast<std::size_t>(static_cast<int>(y) * kCells + static_cast<int>(x))];
}

BoardPattern::BoardPattern(const BoardDescription& board) : board_(board) {
  const Eigen::Vector2d count(board.columns, board.rows);
  if (board.pattern == BoardDescription::Pattern::Checkerboard) {
    half_size_m_ = 0.5 * board.pitch_m * (count.array() + 3.0);  // inner corners, so one square more, and the margins
    return;
  }
  half_size_m_ = 0.5 * board.pitch_m * count;
  for (int i = 0; i < board.columns * board.rows; ++i) tags_.emplace_back(board.first_tag_id + i);
}

double BoardPattern::albedo_at(const Eigen::Vector2d& place_m) const {
  const Eigen::Array2d from_corner = (place_m + half_size_m_).array() / board_.pitch_m;
  const Eigen::Array2d extent = 2.0 * half_size_m_.array() / board_.pitch_m;
  if (!((from_corner >= 0.0).all() && (from_corner < extent).all())) return 0.0;
  const Eigen::Array2i cell = from_corner.cast<int>();
  if (board_.pattern == BoardDescription::Pattern::Checkerboard) {
    const bool square = cell.x() >= 1 && cell.y() >= 1 && cell.x() <= board_.columns + 1 && cell.y() <= board_.rows + 1;
    return square && (cell.x() + cell.y()) % 2 == 0 ? kPrintedBlack : board_.albedo;
  }
  const TagPattern& tag = tags_[static_cast<std::size_t>(cell.y() * board_.columns + cell.x())];
  const Eigen::Vector2d in_tag = (from_corner - cell.cast<double>() - 0.5) * (board_.pitch_m / board_.tag_size_m);
  return tag.white_at(in_tag) ? board_.albedo : kPrintedBlack;
}

}  // namespace lumitexel
