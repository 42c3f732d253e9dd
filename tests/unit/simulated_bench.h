// The bench of config/rigs/simulated.toml with a quarter of its pixels per side and nothing hidden: for tests.
#pragma once

#include <memory>

#include "rig/rig_description.h"
#include "sim/simulated_world.h"

namespace lumitexel {

inline RigDescription small_bench() {
  RigDescription rig;
  rig.name = "small bench";
  rig.camera.limits = {.width_px = 256, .height_px = 192, .bits = 14, .mosaic = Mosaic::Rggb, .exposure_min_s = 1e-5,
                       .exposure_max_s = 30.0, .exposure_step_s = 1e-6, .readout_s = 0.15};
  rig.camera.lens = {737.5, 737.5, 129.0, 95.0, -0.08, 0.15, 0.0004, -0.0003};
  rig.camera.sensor = {.electrons_per_dn = 1.2, .full_well_e = 18000.0, .read_noise_e = 4.0, .black_level_dn = 256.0};
  const Eigen::Vector3d eye(0.75 / std::sqrt(0.75), 0.0, 0.5);
  Eigen::Matrix3d axes;  // rows: right, down, forward
  axes.row(2) = -eye.normalized();
  axes.row(0) = Eigen::Vector3d::UnitY();
  axes.row(1) = axes.row(2).transpose().cross(Eigen::Vector3d::UnitY());
  rig.camera.camera_from_rig.linear() = axes;
  rig.camera.camera_from_rig.translation() = -axes * eye;
  rig.turntable.speed_deg_per_s = 20.0;
  rig.turntable.settle_s = 0.5;
  rig.light_positioner.azimuth_min_deg = -110.0;
  rig.light_positioner.azimuth_max_deg = 110.0;
  rig.light_positioner.elevation_min_deg = -20.0;
  rig.light_positioner.elevation_max_deg = 85.0;
  rig.light_positioner.speed_deg_per_s = 15.0;
  rig.light_positioner.settle_s = 0.8;
  rig.ring_flash.radius_m = 0.04;
  rig.spheres = {.count = 6, .radius_m = 0.02, .spacing_m = 0.05};
  rig.gray_card = {.albedo = 0.18, .centre_in_rig = {0.05, -0.13, -0.075}, .normal_in_rig = {0.8, 0.1, 0.6},
                   .size_m = 0.04};
  return rig;
}

inline SimulationSettings plain_settings() {
  SimulationSettings settings;
  settings.object_centre_in_table_m = {0.0, 0.0, -0.008};
  settings.first_sphere_in_rig_m = {-0.068, -0.125, 0.0835};
  settings.sphere_line_direction_in_rig = Eigen::Vector3d(0.12, 0.99, 0.03).normalized();
  return settings;
}

inline std::shared_ptr<SimulatedWorld> small_world(const RigDescription& rig = small_bench(),
                                                   const SimulationSettings& settings = plain_settings()) {
  return std::make_shared<SimulatedWorld>(rig, settings, "test");
}

}  // namespace lumitexel
