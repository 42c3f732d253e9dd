// The lamp's angular pattern: how much of its intensity goes into which direction.
//
// The lamp's frame: z from the light to the arm's pivot, y the direction in which the elevation grows, x = y cross z. A
// direction d in it leaves the lamp under the angle theta from the lamp's true axis, which may be tilted a little, by
// (tilt_x, tilt_y) towards x and y:
//   log p(d) = -n l + m l^2,   l = -log cos theta      (n: cos^n; m: its broadest departure from that)
// normalised so that p = 1 along the axis z of the frame. Samples come from surfaces of known pose and albedo, over any
// number of views; every view has an intensity of its own (drift does not matter here), so only ratios within a view
// tell the pattern. What the samples do not ask for stays out: none, n, n and tilt, n and tilt and m, each entering only
// if it lowers the robust chi-square significantly.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace lumitexel {

// Light and frame of a lamp that points at the arm's pivot. Throws BadInput if the light stands on the pivot or above
// it along `up`, so that the frame has no upright.
Eigen::Isometry3d lamp_from_rig(const Eigen::Vector3d& light_in_rig, const Eigen::Vector3d& pivot_in_rig,
                                const Eigen::Vector3d& up_in_rig);

struct PatternSample {
  int view = 0;  // from 0; samples of one view share an intensity
  Eigen::Vector3d position_in_lamp = Eigen::Vector3d::Zero();  // of the diffuse surface, m; z > 0
  Eigen::Vector3d normal_in_lamp = -Eigen::Vector3d::UnitZ();  // unit
  double radiance = 0;  // over albedo / pi: the irradiance by another name; any one unit
  double variance = 0;  // of radiance
};

class LampPattern {
 public:
  static constexpr int kParameters = 4;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;  // n, tilt_x, tilt_y (rad), m

  LampPattern() = default;  // the same into all directions, exactly
  LampPattern(const Parameters& parameters, const Eigen::Matrix4d& covariance)
      : parameters_(parameters), covariance_(covariance) {}

  // p(d) and its one-sigma. d need not be unit. 0 behind the lamp's plane (90 degrees from the axis and more).
  double factor(const Eigen::Vector3d& direction_in_lamp) const;
  double sigma(const Eigen::Vector3d& direction_in_lamp) const;

  const Parameters& parameters() const { return parameters_; }
  const Eigen::Matrix4d& covariance() const { return covariance_; }

 private:
  Parameters parameters_ = Parameters::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Zero();
};

struct PatternFit {
  LampPattern pattern;
  int parameters = 0;  // 0, 1, 3 or 4 of them were needed
  std::vector<double> view_intensity, view_relative_sigma;  // along z, as the views; 0 where a view has no sample
  double chi2_per_freedom = 0;  // of the samples in use, before the covariance was scaled by it (where above one)
  int samples = 0, outliers = 0;
  double widest_rad = 0;  // angle from z up to which samples reach: beyond it the pattern is a guess
  bool converged = false;
};

// Samples that face away from the lamp, lie behind it, or whose radiance is not positive are left out. Throws BadInput
// for a negative view or a variance that is not positive and finite. parameters (0, 1, 3 or 4): so many, whether needed or not.
PatternFit fit_lamp_pattern(const std::vector<PatternSample>& samples, std::optional<int> parameters = {});

// The same where stray lights add to the samples, one share (of the lamp's irradiance) a sample: strays stay in, and how far off the
// same parameters are without them is in the covariance.
PatternFit fit_lamp_pattern(const std::vector<PatternSample>& samples, const std::vector<double>& stray_shares);

// Irradiance at normal incidence over the lamp's intensity along z, at a point: p(d) / distance^2.
double irradiance_per_intensity(const LampPattern& pattern, const Eigen::Vector3d& position_in_lamp);

}  // namespace lumitexel
