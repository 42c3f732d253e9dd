#include "processing/calibration/lens/lens_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lumitexel {
namespace {

const cv::Scalar kInk(0.12, 0.24, 0.55), kRed(0.80, 0.15, 0.10), kShade(0.90, 0.86, 0.80), kLine(0.85, 0.85, 0.85);

struct Canvas {
  Image image;
  double scale;  // canvas pixels per photograph's pixel
  Canvas(const CameraModel& camera, int width_px)
      : image(std::max(16, width_px),
              std::max(1, static_cast<int>(std::lround(static_cast<double>(std::max(16, width_px)) * camera.height_px /
                                                       camera.width_px))),
              3, 1.0f),
        scale(static_cast<double>(image.width) / camera.width_px) {}
  cv::Mat mat() { return cv::Mat(image.height, image.width, CV_32FC3, image.data.data()); }
};

constexpr int kFraction_bits = 4;  // OpenCV draws at sixteenths of a pixel
cv::Point fixed(const Eigen::Vector2d& p) {
  const double unit = 1 << kFraction_bits;
  return {static_cast<int>(std::lround((p.x() - 0.5) * unit)), static_cast<int>(std::lround((p.y() - 0.5) * unit))};
}

void line(cv::Mat canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const cv::Scalar& colour) {
  cv::line(canvas, fixed(from), fixed(to), colour, 1, cv::LINE_8, kFraction_bits);
}

void arrow(cv::Mat canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& step, const cv::Scalar& colour) {
  line(canvas, from, from + step, colour);
  const Eigen::Vector2d back = -0.25 * step, side(-back.y(), back.x());
  line(canvas, from + step, from + step + back + 0.6 * side, colour);
  line(canvas, from + step, from + step + back - 0.6 * side, colour);
}

void shade_empty_cells(Canvas& canvas, const LensCoverage& coverage) {
  if (coverage.counts.empty()) return;
  for (int r = 0; r < coverage.rows; ++r) {
    for (int c = 0; c < coverage.columns; ++c) {
      const int x0 = c * canvas.image.width / coverage.columns, x1 = (c + 1) * canvas.image.width / coverage.columns;
      const int y0 = r * canvas.image.height / coverage.rows, y1 = (r + 1) * canvas.image.height / coverage.rows;
      const cv::Rect cell(x0, y0, x1 - x0, y1 - y0);
      if (coverage.at(c, r) == 0) cv::rectangle(canvas.mat(), cell, kShade, cv::FILLED);
      cv::rectangle(canvas.mat(), cell, kLine);
    }
  }
}

}  // namespace

Image coverage_picture(const LensCalibration& calibration, const std::vector<BoardSighting>& sightings, int width_px) {
  Canvas canvas(calibration.camera, width_px);
  shade_empty_cells(canvas, calibration.coverage);
  const double magnified = canvas.image.width / 50.0 / std::max(1e-12, 2.0 * calibration.rms_px);
  for (std::size_t b = 0; b < std::min(sightings.size(), calibration.boards.size()); ++b) {
    const BoardFit& board = calibration.boards[b];
    if (!board.rejected.empty()) continue;
    for (const Landmark& landmark : sightings[b].landmarks) {
      for (std::size_t i = 0; i < landmark.pixels.size(); ++i) {
        const Eigen::Vector2d predicted = calibration.camera.project(board.camera_from_board * landmark.x_in_board[i]);
        const Eigen::Vector2d at = canvas.scale * landmark.pixels[i];
        cv::circle(canvas.mat(), fixed(at), 1 << kFraction_bits, kInk, cv::FILLED, cv::LINE_8, kFraction_bits);
        line(canvas.mat(), at, at + magnified * (landmark.pixels[i] - predicted), kRed);
      }
    }
  }
  return canvas.image;
}

Image distortion_picture(const CameraModel& camera, int width_px, double* magnification) {
  Canvas canvas(camera, width_px);
  CameraModel straight = camera;
  straight.k1 = straight.k2 = straight.p1 = straight.p2 = 0.0;
  constexpr int kColumns = 18;
  const double pitch = static_cast<double>(camera.width_px) / kColumns;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> steps;
  double longest = 0;
  for (double y = 0.5 * pitch; y < camera.height_px; y += pitch) {
    for (double x = 0.5 * pitch; x < camera.width_px; x += pitch) {
      const Eigen::Vector2d pixel(x, y), step = pixel - straight.project(camera.unproject(pixel));
      steps.emplace_back(pixel, step);
      longest = std::max(longest, step.norm());
    }
  }
  // The longest arrow between a tenth of a grid's pitch and the whole of it.
  const double magnified =
      longest > 1e-9 ? std::pow(10.0, std::max(0.0, std::floor(std::log10(pitch / longest)))) : 1.0;
  if (magnification != nullptr) *magnification = magnified;
  for (const auto& [pixel, step] : steps) {
    cv::circle(canvas.mat(), fixed(canvas.scale * pixel), 1 << kFraction_bits, kInk, cv::FILLED, cv::LINE_8,
               kFraction_bits);
    arrow(canvas.mat(), canvas.scale * (pixel - magnified * step), canvas.scale * magnified * step, kRed);
  }
  return canvas.image;
}

Image vignetting_picture(const Vignetting& vignetting, const CameraModel& camera, int width_px, double least,
                         double step) {
  Canvas canvas(camera, width_px);
  const auto transmission = [&](int x, int y) {
    return vignetting.transmission({(x + 0.5) / canvas.scale, (y + 0.5) / canvas.scale});
  };
  for (int y = 0; y < canvas.image.height; ++y) {
    for (int x = 0; x < canvas.image.width; ++x) {
      const double t = transmission(x, y), band = std::floor(t / step);
      const bool contour =
          std::floor(transmission(x + 1, y) / step) != band || std::floor(transmission(x, y + 1) / step) != band;
      const auto gray = static_cast<float>(std::clamp((t - least) / (1.0 - least), 0.0, 1.0));
      for (int c = 0; c < 3; ++c) canvas.image.at(x, y, c) = contour ? static_cast<float>(kRed[c]) : gray;
    }
  }
  return canvas.image;
}

}  // namespace lumitexel
