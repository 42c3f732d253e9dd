#include "processing/calibration/light/arm_alignment.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPriorLength_m = 0.02, kPriorAngle_rad = 2.0 * kDegree;
constexpr double kOutlierSigmas = 5.0;
constexpr double kLeastScatter_m = 2e-4;  // no arm of a metre repeats better; keeps the merge from being overconfident

ArmAlignment::Parameters prior_sigmas() {
  ArmAlignment::Parameters sigmas;
  sigmas << kPriorLength_m, kPriorLength_m, kPriorLength_m, kPriorAngle_rad, kPriorAngle_rad, kPriorAngle_rad,
      kPriorLength_m, kPriorAngle_rad;
  return sigmas;
}

double mahalanobis2(const Eigen::Vector3d& difference, const Eigen::Matrix3d& covariance) {
  return difference.dot(covariance.inverse() * difference);
}

}  // namespace

ArmAlignment::ArmAlignment(const LightPositionerDescription& nominal, const std::vector<ArmSample>& samples)
    : nominal_(nominal), scatter_m_(kLeastScatter_m) {
  // The scatter decides how much a sample with a tiny covariance may dominate, and follows from the fit: alternate.
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    fit(samples);
    scatter_m_ = likeliest_scatter(samples);
  }
  fit(samples);
  double sum = 0.0;
  int inliers = 0;
  for (const ArmSample& sample : samples) {
    if (is_outlier(sample)) continue;
    sum += (sample.position_in_rig - position(correction_, sample.azimuth_deg, sample.elevation_deg)).squaredNorm();
    ++inliers;
  }
  residual_m_ = inliers > 0 ? std::sqrt(sum / inliers) : 0.0;
}

Eigen::Vector3d ArmAlignment::position(const Parameters& p, double azimuth_deg, double elevation_deg) const {
  const Eigen::Vector3d nominal = nominal_.nominal_position_in_rig(azimuth_deg, elevation_deg + p[7] / kDegree);
  const Eigen::Vector3d direction = (nominal - nominal_.pivot_in_rig) / nominal_.radius_m;
  const Eigen::Vector3d turn = p.segment<3>(3);
  const double angle = turn.norm();
  const Eigen::Vector3d turned = angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle) * direction : direction;
  return nominal_.pivot_in_rig + p.head<3>() + (nominal_.radius_m + p[6]) * turned;
}

Eigen::Matrix<double, 3, ArmAlignment::kParameters> ArmAlignment::jacobian(double azimuth_deg,
                                                                           double elevation_deg) const {
  Eigen::Matrix<double, 3, kParameters> j;
  constexpr double kStep = 1e-5;  // metres and radians; the arm is smooth over metres
  for (int k = 0; k < kParameters; ++k) {
    Parameters up = correction_, down = correction_;
    up[k] += kStep;
    down[k] -= kStep;
    j.col(k) = (position(up, azimuth_deg, elevation_deg) - position(down, azimuth_deg, elevation_deg)) / (2.0 * kStep);
  }
  return j;
}

void ArmAlignment::fit(const std::vector<ArmSample>& samples) {
  const Parameters prior = prior_sigmas().cwiseInverse().cwiseAbs2();
  constexpr int kIterations = 20;  // Gauss-Newton from near the solution, weights renewed each time
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix<double, kParameters, kParameters> normal = prior.asDiagonal();
    Parameters right = -prior.cwiseProduct(correction_);
    for (const ArmSample& sample : samples) {
      const Eigen::Vector3d difference =
          sample.position_in_rig - position(correction_, sample.azimuth_deg, sample.elevation_deg);
      const Eigen::Matrix3d information = information_of(sample);
      const auto j = jacobian(sample.azimuth_deg, sample.elevation_deg);
      normal += j.transpose() * information * j;
      right += j.transpose() * information * difference;
    }
    correction_ += normal.ldlt().solve(right);
    covariance_ = normal.inverse();
  }
}

// Of the sample about the arm, as much of it as counts.
Eigen::Matrix3d ArmAlignment::information_of(const ArmSample& sample) const {
  const Eigen::Matrix3d covariance = sample.covariance + scatter_m_ * scatter_m_ * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d difference =
      sample.position_in_rig - position(correction_, sample.azimuth_deg, sample.elevation_deg);
  // Cauchy weights: one at the centre, vanishing for a view whose highlights were mistaken.
  const double weight = 1.0 / (1.0 + mahalanobis2(difference, covariance) / (kOutlierSigmas * kOutlierSigmas));
  return weight * covariance.inverse();
}

// The normal equations less the sample's part.
ArmPrediction ArmAlignment::predict_without(const ArmSample& sample) const {
  const auto j = jacobian(sample.azimuth_deg, sample.elevation_deg);
  const Eigen::Matrix3d information = information_of(sample);
  const Eigen::Vector3d fitted = position(correction_, sample.azimuth_deg, sample.elevation_deg);
  const Eigen::Matrix<double, kParameters, kParameters> covariance =
      (covariance_.inverse() - j.transpose() * information * j).inverse();
  const Eigen::Vector3d back = j * covariance * j.transpose() * information * (sample.position_in_rig - fitted);
  return {fitted - back, j * covariance * j.transpose() + scatter_m_ * scatter_m_ * Eigen::Matrix3d::Identity()};
}

double ArmAlignment::likeliest_scatter(const std::vector<ArmSample>& samples) const {
  double best = kLeastScatter_m, best_cost = std::numeric_limits<double>::infinity();
  constexpr double kMostScatter_m = 0.05, kFactor = 1.1;
  for (double scatter = kLeastScatter_m; scatter < kMostScatter_m; scatter *= kFactor) {
    double cost = 0.0;
    for (const ArmSample& sample : samples) {
      const Eigen::Matrix3d covariance = sample.covariance + scatter * scatter * Eigen::Matrix3d::Identity();
      const double distance2 = mahalanobis2(
          sample.position_in_rig - position(correction_, sample.azimuth_deg, sample.elevation_deg), covariance);
      const double bound = kOutlierSigmas * kOutlierSigmas;  // an outlier says nothing about the arm
      cost += std::min(distance2, bound) + std::log(covariance.determinant());
    }
    if (cost < best_cost) {
      best_cost = cost;
      best = scatter;
    }
  }
  return best;
}

ArmPrediction ArmAlignment::predict(double azimuth_deg, double elevation_deg) const {
  const auto j = jacobian(azimuth_deg, elevation_deg);
  return {position(correction_, azimuth_deg, elevation_deg),
          j * covariance_ * j.transpose() + scatter_m_ * scatter_m_ * Eigen::Matrix3d::Identity()};
}

ArmPrediction ArmAlignment::combine(const ArmSample& sample) const {
  const ArmPrediction predicted = predict_without(sample);
  const Eigen::Matrix3d from_arm = predicted.covariance.inverse(), from_spheres = sample.covariance.inverse();
  const Eigen::Matrix3d covariance = (from_arm + from_spheres).inverse();
  return {covariance * (from_arm * predicted.position_in_rig + from_spheres * sample.position_in_rig), covariance};
}

bool ArmAlignment::is_outlier(const ArmSample& sample) const {
  const ArmPrediction predicted = predict(sample.azimuth_deg, sample.elevation_deg);
  return mahalanobis2(sample.position_in_rig - predicted.position_in_rig, predicted.covariance + sample.covariance) >
         kOutlierSigmas * kOutlierSigmas;
}

}  // namespace lumitexel
