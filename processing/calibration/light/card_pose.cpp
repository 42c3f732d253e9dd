#include "processing/calibration/light/card_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <set>
#include <string>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Step = Eigen::Matrix<double, 6, 1>;
using Normal = Eigen::Matrix<double, 6, 6>;

struct Corner {
  Eigen::Vector3d on_card;  // about the corners' centroid
  Eigen::Vector2d pixel;
  double sigma_px;
};

std::vector<Corner> matched_corners(const std::vector<TagDescription>& tags, const std::vector<SeenTag>& seen) {
  std::vector<Corner> corners;
  std::set<int> ids;
  for (const SeenTag& s : seen) {
    const bool finite = std::all_of(s.corners_px.begin(), s.corners_px.end(), [](const auto& p) { return p.allFinite(); });
    if (!finite || !(s.sigma_px > 0.0) || !ids.insert(s.id).second) {
      throw BadInput("card pose: tag " + std::to_string(s.id),
                     finite ? "a sigma of " + std::to_string(s.sigma_px) + " px, or seen twice" : "a pixel not finite",
                     "each tag once, finite corners, a positive sigma");
    }
    const auto tag = std::find_if(tags.begin(), tags.end(), [&](const TagDescription& t) { return t.id == s.id; });
    if (tag == tags.end()) continue;
    for (std::size_t k = 0; k < 4; ++k) corners.push_back({tag->corners()[k], s.corners_px[k], s.sigma_px});
  }
  return corners;
}

Eigen::Vector3d take_out_centroid(std::vector<Corner>& corners) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Corner& c : corners) centroid += c.on_card / static_cast<double>(corners.size());
  for (Corner& c : corners) c.on_card -= centroid;
  return centroid;
}

// Both poses of a plane that solvePnP's IPPE gives; corners off one plane get its general start.
std::vector<Eigen::Isometry3d> start_poses(const CameraModel& camera, const std::vector<Corner>& corners) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> directions;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Corner& c : corners) {
    points.emplace_back(c.on_card.x(), c.on_card.y(), c.on_card.z());
    const Eigen::Vector2d d = camera.unproject(c.pixel).hnormalized();
    directions.emplace_back(d.x(), d.y());
    spread += c.on_card * c.on_card.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  constexpr double kFlat = 1e-6;  // of the extent, squared
  const bool flat = eigen.eigenvalues()[0] < kFlat * eigen.eigenvalues()[2];
  std::vector<cv::Mat> turns, shifts;
  cv::solvePnPGeneric(points, directions, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, shifts, false,
                      flat ? cv::SOLVEPNP_IPPE : cv::SOLVEPNP_EPNP);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Eigen::Vector3d turn(turns[i].at<double>(0), turns[i].at<double>(1), turns[i].at<double>(2));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (turn.norm() > 0.0) pose.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(shifts[i].at<double>(0), shifts[i].at<double>(1), shifts[i].at<double>(2));
    if (pose.matrix().allFinite() && pose.translation().z() > 0.0) poses.push_back(pose);
  }
  return poses;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Step& step) {
  const double angle = step.head<3>().norm();
  Eigen::Isometry3d result = pose;
  if (angle > 0.0) result.linear() = Eigen::AngleAxisd(angle, step.head<3>() / angle) * pose.linear();
  result.translation() += step.tail<3>();
  return result;
}

// In sigmas; infinite behind the camera.
Eigen::VectorXd residuals(const CameraModel& camera, const std::vector<Corner>& corners, const Eigen::Isometry3d& pose) {
  Eigen::VectorXd r(2 * static_cast<Eigen::Index>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d x = pose * corners[i].on_card;
    const auto k = 2 * static_cast<Eigen::Index>(i);
    if (!(x.z() > 0.0)) return r.setConstant(std::numeric_limits<double>::infinity());
    r.segment<2>(k) = (camera.project(x) - corners[i].pixel) / corners[i].sigma_px;
  }
  return r;
}

Eigen::MatrixXd jacobian(const CameraModel& camera, const std::vector<Corner>& corners, const Eigen::Isometry3d& pose) {
  Eigen::MatrixXd j(2 * static_cast<Eigen::Index>(corners.size()), 6);
  for (int k = 0; k < 6; ++k) {
    Step step = Step::Zero();
    step[k] = k < 3 ? 1e-6 : 1e-6 * pose.translation().norm();
    j.col(k) = (residuals(camera, corners, moved(pose, step)) - residuals(camera, corners, moved(pose, -step))) / (2.0 * step[k]);
  }
  return j;
}

struct Refined {
  Eigen::Isometry3d pose;
  double chi2 = std::numeric_limits<double>::infinity();
  bool converged = false;
};

Refined refine(const CameraModel& camera, const std::vector<Corner>& corners, const Eigen::Isometry3d& start) {
  Refined best{start, residuals(camera, corners, start).squaredNorm(), false};
  double damping = 1e-3;
  constexpr int kMaxIterations = 100;
  for (int i = 0; i < kMaxIterations && damping < 1e12 && !best.converged; ++i) {
    const Eigen::MatrixXd j = jacobian(camera, corners, best.pose);
    Normal normal = j.transpose() * j;
    normal.diagonal() *= 1.0 + damping;
    const Step step = -normal.ldlt().solve(j.transpose() * residuals(camera, corners, best.pose));
    const Eigen::Isometry3d next = moved(best.pose, step);
    const double chi2 = residuals(camera, corners, next).squaredNorm();
    const double relative_step = step.head<3>().norm() + step.tail<3>().norm() / best.pose.translation().norm();
    if (chi2 <= best.chi2) {
      best.pose = next;
      best.chi2 = chi2;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
    best.converged = relative_step < 1e-9 && std::isfinite(best.chi2);
  }
  return best;
}

// Intensity goes with distance^2 / cosine: its logarithm at the card's centre, all in the camera's frame.
double log_geometry(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, const Eigen::Vector3d& light) {
  const Eigen::Vector3d to_light = light - centre;
  return 3.0 * std::log(to_light.norm()) - std::log(to_light.dot(normal));
}

}  // namespace

CardPose solve_card_pose(const CameraModel& camera, const std::vector<TagDescription>& tags,
                         const std::vector<SeenTag>& seen) {
  std::vector<Corner> corners = matched_corners(tags, seen);
  CardPose result;
  if (corners.empty()) return result;
  const Eigen::Vector3d centroid = take_out_centroid(corners);
  std::vector<Refined> solutions;
  for (const Eigen::Isometry3d& start : start_poses(camera, corners)) {
    const Refined refined = refine(camera, corners, start);
    if (refined.converged) solutions.push_back(refined);
  }
  if (solutions.empty()) return result;
  std::sort(solutions.begin(), solutions.end(), [](const Refined& a, const Refined& b) { return a.chi2 < b.chi2; });
  const Refined& best = solutions.front();
  const double freedom = 2.0 * static_cast<double>(corners.size()) - 6.0;
  result.sigma_scale = std::max(1.0, std::sqrt(best.chi2 / freedom));
  result.chi2_gap = std::numeric_limits<double>::infinity();
  for (const Refined& other : solutions) {
    constexpr double kSame_rad = 1e-4;
    const double turn = Eigen::AngleAxisd(best.pose.linear().transpose() * other.pose.linear()).angle();
    if (turn < kSame_rad) continue;
    result.chi2_gap = (other.chi2 - best.chi2) / (result.sigma_scale * result.sigma_scale);
    break;
  }
  result.ambiguous = result.chi2_gap < CardPose::kLeastGap;
  const Eigen::MatrixXd j = jacobian(camera, corners, best.pose);
  result.covariance = (j.transpose() * j).inverse() * (result.sigma_scale * result.sigma_scale);
  result.found = result.covariance.allFinite();
  result.camera_from_card = best.pose * Eigen::Translation3d(-centroid);
  result.pivot_in_camera = best.pose.translation();
  double square = 0.0;
  const Eigen::VectorXd r = residuals(camera, corners, best.pose);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    square += r.segment<2>(2 * static_cast<Eigen::Index>(i)).squaredNorm() * std::pow(corners[i].sigma_px, 2);
  }
  result.residual_px = std::sqrt(square / static_cast<double>(r.size()));
  return result;
}

PosedCardIntensity measure_posed_card(const MosaicRadiance& picture, const CameraModel& camera, const CardPose& pose,
                                      const GrayCardDescription& card, const Eigen::Vector3d& light_in_camera,
                                      const Eigen::Matrix3d& light_covariance_m2) {
  if (!pose.found) throw BadInput("gray card", "a pose that was not found", "tags of the card in the picture");
  PosedCardIntensity result;
  result.measured = measure_gray_card(picture, camera, pose.camera_from_card, card,
                                      pose.camera_from_card.inverse() * light_in_camera);
  const Eigen::Vector3d centre = pose.camera_from_card * card.centre_in_rig;
  const Eigen::Vector3d normal = pose.camera_from_card.linear() * card.normal_in_rig.normalized();
  Step by_pose;
  Eigen::Vector3d by_light;
  constexpr double kStep = 1e-6;  // rad and m
  for (int k = 0; k < 6; ++k) {
    const auto at = [&](double sign) {
      const Eigen::Vector3d turn = k < 3 ? Eigen::Vector3d(sign * kStep * Eigen::Vector3d::Unit(k)) : Eigen::Vector3d::Zero();
      const Eigen::Vector3d shift = k < 3 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(sign * kStep * Eigen::Vector3d::Unit(k - 3));
      const Eigen::Vector3d arm = centre - pose.pivot_in_camera;
      return log_geometry(centre + turn.cross(arm) + shift, (normal + turn.cross(normal)).normalized(), light_in_camera);
    };
    by_pose[k] = (at(1.0) - at(-1.0)) / (2.0 * kStep);
    if (k < 3) {
      const Eigen::Vector3d shift = kStep * Eigen::Vector3d::Unit(k);
      by_light[k] = (log_geometry(centre, normal, light_in_camera + shift) -
                     log_geometry(centre, normal, light_in_camera - shift)) / (2.0 * kStep);
    }
  }
  result.pose_sigma = std::sqrt(by_pose.dot(pose.covariance * by_pose));
  result.light_sigma = std::sqrt(by_light.dot(light_covariance_m2 * by_light));
  for (const double pixels : result.measured.relative_sigma) {
    result.relative_sigma.push_back(std::sqrt(pixels * pixels + std::pow(result.pose_sigma, 2) + std::pow(result.light_sigma, 2)));
  }
  return result;
}

}  // namespace lumitexel
