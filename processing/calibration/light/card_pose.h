// Where the gray card stands in the camera's frame, from the AprilTags on its frame; and what that makes of its radiance.
//
// Card and tags are one rigid body, described in the rig's frame as the rig's file gives it; the pose found,
// camera_from_card, takes that description's coordinates to the camera. It replaces camera_from_rig for the card alone.
// Least squares on the corners' pixels, each weighted by its sigma, from both solutions that four or more points in a
// plane allow; covariance from the Jacobian at the better one. If the worse one fits nearly as well, the pose is ambiguous.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/gray_card.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct SeenTag {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners_px;  // in the order of TagDescription::corners()
  double sigma_px = 0.05;                     // per coordinate
};

struct CardPose {
  bool found = false;      // false: no tag of the card seen, or no convergence; the rest means nothing
  bool ambiguous = false;  // the other solution's chi-square is within kLeastGap of this one's
  Eigen::Isometry3d camera_from_card = Eigen::Isometry3d::Identity();
  // Of a small turn (3, rad, about the tags' centroid, camera's axes), then of the centroid (3, m, camera's axes).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d pivot_in_camera = Eigen::Vector3d::Zero();  // the centroid that the turn is about
  double residual_px = 0;    // rms of a coordinate
  double sigma_scale = 1;    // residuals over the stated sigmas, at least one; the covariance holds its square
  double chi2_gap = 0;       // of the other solution over this one, in units of sigma_scale^2
  static constexpr double kLeastGap = 20.0;  // the wrong one wins by chance beyond this in less than 1 of 10,000
};

// tags: those on the card's frame, in the frame in which the card is described. seen: any; ids that `tags` has not are
// ignored. Throws BadInput for a sigma that is not positive, a pixel that is not finite, or an id seen twice.
CardPose solve_card_pose(const CameraModel& camera, const std::vector<TagDescription>& tags,
                         const std::vector<SeenTag>& seen);

struct PosedCardIntensity {
  GrayCardIntensity measured;
  double pose_sigma = 0;   // relative: by the card's distance and tilt to the light
  double light_sigma = 0;  // relative: by the light's position
  std::vector<double> relative_sigma;  // per channel, of pixels, pose and light together
};

// measure_gray_card for a card whose pose was found and a light given in the camera's frame. Throws what
// measure_gray_card throws, and BadInput for a pose that was not found.
PosedCardIntensity measure_posed_card(const MosaicRadiance& picture, const CameraModel& camera, const CardPose& pose,
                                      const GrayCardDescription& card, const Eigen::Vector3d& light_in_camera,
                                      const Eigen::Matrix3d& light_covariance_m2);

}  // namespace lumitexel
