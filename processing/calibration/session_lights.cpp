#include "processing/calibration/session_lights.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

std::vector<ArmSample> arm_samples(const LightSolution& solution, const std::vector<ViewFrames>& views,
                                   const Eigen::Isometry3d& rig_from_camera) {
  std::vector<ArmSample> samples;
  const Eigen::Matrix3d turn = rig_from_camera.linear();
  for (std::size_t v = 0; v < views.size(); ++v) {
    const FrameRecord& shot = views[v].spheres.point;
    samples.push_back({shot.light_azimuth_deg, shot.light_elevation_deg, rig_from_camera * solution.lights[v].position,
                       turn * solution.lights[v].own_covariance * turn.transpose()});
  }
  return samples;
}

ArmAlignment align_arm(const LightPositionerDescription& nominal, const LightSolution& solution,
                       const std::vector<ArmSample>& all) {
  std::vector<ArmSample> measured;
  for (std::size_t v = 0; v < all.size(); ++v) {
    if (solution.lights[v].measured) measured.push_back(all[v]);
  }
  return ArmAlignment(nominal, measured);
}

LightSummary summarise(const std::string& name, const MeasuredLight& measured, const ArmSample& sample,
                       const ArmAlignment& arm) {
  LightSummary light;
  light.view = name;
  light.highlights = measured.highlights;
  light.outliers = measured.outliers;
  light.residual_px = measured.residual_px;
  light.off_the_arm = measured.measured && arm.is_outlier(sample);
  light.from_spheres = measured.measured && !light.off_the_arm;
  if (measured.measured) {
    light.spheres_alone_in_world = sample.position_in_rig;
    light.spheres_alone_sigma_m = per_axis_sigma(measured.covariance);
  }
  return light;
}

}  // namespace

double per_axis_sigma(const Eigen::Matrix3d& covariance) { return std::sqrt(covariance.trace() / 3.0); }

SessionLights align_lights(LightSolution spheres, const std::vector<ViewFrames>& views, const CapturePlan& plan,
                           const RigDescription& rig, const Eigen::Isometry3d& camera_from_rig) {
  const std::vector<ArmSample> samples = arm_samples(spheres, views, camera_from_rig.inverse());
  SessionLights lights{spheres, align_arm(rig.light_positioner, spheres, samples), {}, per_axis_sigma(spheres.shared_covariance), {}};
  for (std::size_t v = 0; v < views.size(); ++v) {
    LightSummary light = summarise(plan.views[v].name, spheres.lights[v], samples[v], lights.arm);
    lights.in_rig.push_back(light.from_spheres
                                ? lights.arm.combine(samples[v])
                                : lights.arm.predict(samples[v].azimuth_deg, samples[v].elevation_deg));
    light.position_in_world = lights.in_rig.back().position_in_rig;
    light.sigma_m = std::hypot(per_axis_sigma(lights.in_rig.back().covariance), lights.shared_sigma_m);
    lights.summaries.push_back(std::move(light));
  }
  return lights;
}

}  // namespace lumitexel
