// How the light's arm really stands: a small correction of its nominal geometry, from all lights that the spheres
// measured.
//
//   position(azimuth, elevation) = pivot + offset + (radius + stretch) * turn * nominal direction(azimuth, elevation +
//   lift)
//
// with `turn` a small rotation (its part about the azimuth axis is the azimuth's zero error) and `lift` the elevation's
// zero error. It predicts the light where no sphere shot was taken (the gray card's bracket), tells a mismeasured view
// apart, and, since an arm repeats far better than one view's spheres can tell a distance, improves every view.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rig/rig_description.h"

namespace lumitexel {

struct ArmSample {
  double azimuth_deg = 0, elevation_deg = 0;                  // as read back
  Eigen::Vector3d position_in_rig = Eigen::Vector3d::Zero();  // as measured
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();   // m^2
};

struct ArmPrediction {
  Eigen::Vector3d position_in_rig = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the correction and the arm's scatter, m^2
};

class ArmAlignment {
 public:
  static constexpr int kParameters = 8;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;  // offset (3, m), turn (3, rad), stretch (m), lift (rad)

  // Weighted least squares with a heavy-tailed loss, and with a weak prior (2 cm, 2 degrees) so that a few views
  // suffice. Without samples: the nominal geometry with the prior's uncertainty.
  ArmAlignment(const LightPositionerDescription& nominal, const std::vector<ArmSample>& samples);

  ArmPrediction predict(double azimuth_deg, double elevation_deg) const;
  // The measurement and what the arm says without it, merged, each with its covariance. The sample must be one of those that the
  // alignment was made from.
  ArmPrediction combine(const ArmSample& sample) const;
  // Whether the sample lies farther from the arm than 5 standard deviations.
  bool is_outlier(const ArmSample& sample) const;

  const Parameters& correction() const { return correction_; }
  double scatter_m() const {
    return scatter_m_;
  }  // of single positions about the arm, per axis, beyond their covariances
  double residual_m() const { return residual_m_; }  // rms distance of the samples from the arm, outliers left out

 private:
  Eigen::Vector3d position(const Parameters& correction, double azimuth_deg, double elevation_deg) const;
  Eigen::Matrix<double, 3, kParameters> jacobian(double azimuth_deg, double elevation_deg) const;
  ArmPrediction predict_without(const ArmSample& sample) const;
  Eigen::Matrix3d information_of(const ArmSample& sample) const;
  void fit(const std::vector<ArmSample>& samples);
  double likeliest_scatter(const std::vector<ArmSample>& samples) const;

  LightPositionerDescription nominal_;
  Parameters correction_ = Parameters::Zero();
  Eigen::Matrix<double, kParameters, kParameters> covariance_;
  double scatter_m_ = 0, residual_m_ = 0;
};

}  // namespace lumitexel
