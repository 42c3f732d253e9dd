#include "processing/calibration/pose/contour_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace lumitexel {
namespace {

constexpr int kCellsAlong = 512;
constexpr double kSameWay = 0.7;  // least cosine between the two normals

}  // namespace

ContourLookup::ContourLookup(const SilhouetteContour& contour) : contour_(contour) {
  cell_px_ = std::max(1.0, static_cast<double>(std::max(contour.width_px, contour.height_px)) / kCellsAlong);
  columns_ = static_cast<int>(std::ceil(contour.width_px / cell_px_));
  rows_ = static_cast<int>(std::ceil(contour.height_px / cell_px_));
  const auto cell_of = [&](const ContourPoint& point) {
    const int column = std::clamp(static_cast<int>(point.pixel.x() / cell_px_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(point.pixel.y() / cell_px_), 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  };
  std::stable_sort(contour_.points.begin(), contour_.points.end(),
                   [&](const ContourPoint& a, const ContourPoint& b) { return cell_of(a) < cell_of(b); });
  first_in_cell_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const ContourPoint& point : contour_.points) ++first_in_cell_[cell_of(point) + 1];
  for (std::size_t i = 1; i < first_in_cell_.size(); ++i) first_in_cell_[i] += first_in_cell_[i - 1];
  for (int direction = 0; direction < kDirections; ++direction) build_direction(direction);
}

std::size_t ContourLookup::direction_of(const Eigen::Vector2d& normal) const {
  const double turn = std::atan2(normal.y(), normal.x()) / (2.0 * std::numbers::pi);
  return static_cast<std::size_t>(static_cast<int>(std::lround((turn + 1.0) * kDirections)) % kDirections);
}

void ContourLookup::build_direction(int direction) {
  const double angle = 2.0 * std::numbers::pi * direction / kDirections;
  const Eigen::Vector2d wanted(std::cos(angle), std::sin(angle));
  cv::Mat empty(rows_, columns_, CV_8U, cv::Scalar(255)), distance, labels;
  bool any = false;
  for (std::size_t cell = 0; cell + 1 < first_in_cell_.size(); ++cell) {
    for (std::uint32_t i = first_in_cell_[cell]; i < first_in_cell_[cell + 1]; ++i) {
      if (contour_.points[i].normal.dot(wanted) < kSameWay) continue;
      empty.at<std::uint8_t>(static_cast<int>(cell) / columns_, static_cast<int>(cell) % columns_) = 0;
      any = true;
      break;
    }
  }
  const auto d = static_cast<std::size_t>(direction);
  const std::size_t size = first_in_cell_.size() - 1;
  distance_cells_[d].assign(size, static_cast<float>(columns_ + rows_));
  nearest_cell_[d].assign(size, -1);
  if (!any) return;
  cv::distanceTransform(empty, distance, labels, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<std::int32_t> cell_of_label(size + 1, -1);
  for (std::size_t cell = 0; cell < size; ++cell) {
    const int row = static_cast<int>(cell) / columns_, column = static_cast<int>(cell) % columns_;
    if (empty.at<std::uint8_t>(row, column) == 0)
      cell_of_label[static_cast<std::size_t>(labels.at<std::int32_t>(row, column))] = static_cast<std::int32_t>(cell);
  }
  for (std::size_t cell = 0; cell < size; ++cell) {
    const int row = static_cast<int>(cell) / columns_, column = static_cast<int>(cell) % columns_;
    distance_cells_[d][cell] = distance.at<float>(row, column);
    nearest_cell_[d][cell] = cell_of_label[static_cast<std::size_t>(labels.at<std::int32_t>(row, column))];
  }
}

double ContourLookup::distance_px(const Eigen::Vector2d& pixel, std::size_t direction) const {
  const int column = std::clamp(static_cast<int>(pixel.x() / cell_px_), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(pixel.y() / cell_px_), 0, rows_ - 1);
  const std::vector<float>& distances = distance_cells_[direction];
  return cell_px_ * distances[static_cast<std::size_t>(row * columns_ + column)];
}

const ContourPoint* ContourLookup::nearest(const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal,
                                           double reach_px) const {
  const int column = static_cast<int>(std::floor(pixel.x() / cell_px_)), row = static_cast<int>(std::floor(pixel.y() / cell_px_));
  if (!in_grid(column, row)) return nullptr;
  const std::size_t d = direction_of(normal), here = static_cast<std::size_t>(row * columns_ + column);
  const std::int32_t centre = nearest_cell_[d][here];
  if (centre < 0 || cell_px_ * (distance_cells_[d][here] - 2.0) > reach_px) return nullptr;
  const ContourPoint* best = nullptr;
  double best_sq = reach_px * reach_px;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = centre % columns_ + dx, y = centre / columns_ + dy;
      if (!in_grid(x, y)) continue;
      const auto cell = static_cast<std::size_t>(y * columns_ + x);
      for (std::uint32_t i = first_in_cell_[cell]; i < first_in_cell_[cell + 1]; ++i) {
        const ContourPoint& point = contour_.points[i];
        const double distance_sq = (point.pixel - pixel).squaredNorm();
        if (distance_sq >= best_sq || point.normal.dot(normal) < kSameWay) continue;
        best = &point;
        best_sq = distance_sq;
      }
    }
  }
  return best;
}

}  // namespace lumitexel
