#include "processing/calibration/lens/lens_start.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace lumitexel {
namespace {

struct PlaneView {
  std::vector<cv::Point2d> board, pixel;
  Eigen::Matrix3d homography;
};

PlaneView plane_view(const BoardSighting& sighting) {
  PlaneView view;
  for (const Landmark& landmark : sighting.landmarks) {
    for (std::size_t i = 0; i < landmark.pixels.size(); ++i) {
      view.board.emplace_back(landmark.x_in_board[i].x(), landmark.x_in_board[i].y());
      view.pixel.emplace_back(landmark.pixels[i].x(), landmark.pixels[i].y());
    }
  }
  const cv::Mat h = cv::findHomography(view.board, view.pixel);
  view.homography.setZero();
  if (!h.empty()) {
    for (int i = 0; i < 9; ++i) view.homography(i / 3, i % 3) = h.at<double>(i / 3, i % 3);
  }
  return view;
}

Eigen::Isometry3d pose_from(const Eigen::Matrix3d& homography, const CameraModel& camera) {
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
  k.diagonal() << camera.focal_x_px, camera.focal_y_px, 1.0;
  k.col(2) << camera.principal_x_px, camera.principal_y_px, 1.0;
  Eigen::Matrix3d m = k.inverse() * homography;
  m *= (m(2, 2) < 0.0 ? -2.0 : 2.0) / (m.col(0).norm() + m.col(1).norm());
  const Eigen::JacobiSVD<Eigen::Matrix<double, 3, 2>, Eigen::FullPivHouseholderQRPreconditioner> svd(
      m.leftCols<2>(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix<double, 3, 2> axes = svd.matrixU().leftCols<2>() * svd.matrixV().transpose();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << axes, axes.col(0).cross(axes.col(1));
  pose.translation() = m.col(2);
  return pose;
}

double rms_of(const PlaneView& view, const CameraModel& camera) {
  const Eigen::Isometry3d pose = pose_from(view.homography, camera);
  double squares = 0;
  for (std::size_t i = 0; i < view.board.size(); ++i) {
    const Eigen::Vector3d x = pose * Eigen::Vector3d(view.board[i].x, view.board[i].y, 0.0);
    if (!(x.z() > 0.0)) return std::numeric_limits<double>::infinity();
    squares += (camera.project(x) - Eigen::Vector2d(view.pixel[i].x, view.pixel[i].y)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(view.board.size()));
}

}  // namespace

CameraModel starting_camera(int width_px, int height_px, const std::vector<BoardSighting>& sightings) {
  std::vector<PlaneView> views;
  for (const BoardSighting& sighting : sightings) views.push_back(plane_view(sighting));
  std::erase_if(views, [](const PlaneView& view) { return view.homography.isZero(0.0); });
  CameraModel best{width_px, height_px, 1.2 * width_px, 1.2 * width_px, 0.5 * width_px, 0.5 * height_px};
  double least = std::numeric_limits<double>::infinity();
  constexpr double kFirst = 0.3, kLast = 40.0, kStep = 1.1;
  for (double widths = kFirst; widths <= kLast && !views.empty(); widths *= kStep) {
    CameraModel camera = best;
    camera.focal_x_px = camera.focal_y_px = widths * width_px;
    std::vector<double> errors;
    for (const PlaneView& view : views) errors.push_back(rms_of(view, camera));
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    if (*middle < least) least = *middle, best = camera;
  }
  return best;
}

PlacedBoard place_board(const CameraModel& camera, const BoardSighting& sighting) {
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> seen;
  for (const Landmark& landmark : sighting.landmarks) {
    for (std::size_t i = 0; i < landmark.pixels.size(); ++i) {
      board.emplace_back(landmark.x_in_board[i].x(), landmark.x_in_board[i].y(), 0.0);
      const Eigen::Vector3d ray = camera.unproject(landmark.pixels[i]);
      seen.emplace_back(ray.x() / ray.z(), ray.y() / ray.z());
    }
  }
  std::vector<cv::Mat> turns, shifts;
  cv::solvePnPGeneric(board, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, shifts, false, cv::SOLVEPNP_IPPE);
  PlacedBoard best{sighting, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1))};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < turns.size(); ++s) {
    const Eigen::Vector3d turn(turns[s].at<double>(0), turns[s].at<double>(1), turns[s].at<double>(2));
    if (!turn.allFinite()) continue;
    std::vector<PlacedBoard> trial{{sighting, Eigen::Isometry3d::Identity()}};
    if (turn.norm() > 0.0)
      trial[0].camera_from_board.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
    trial[0].camera_from_board.translation() << shifts[s].at<double>(0), shifts[s].at<double>(1),
        shifts[s].at<double>(2);
    CameraModel fixed = camera;
    refine_boards(fixed, LensMask{}, trial);
    const double chi2 = board_misfit(camera, trial[0]).chi2;
    if (chi2 < least) least = chi2, best = trial[0];
  }
  return best;
}

}  // namespace lumitexel
