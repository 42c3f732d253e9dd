// The [simulation] table of a rig: what only the simulated world knows. Every key has a unit in its name and a range;
// a key that is missing takes the default below, a key that is not listed here is an error.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/bench_behaviour.h"

namespace lumitexel {

struct SimulationSettings : BenchBehaviour {
  int samples_per_pixel = 4;  // a square number, on a regular grid

  // The object. "vase", or an OBJ or PLY file relative to the rig file's folder.
  std::string object = "vase";
  std::string object_up = "z";  // the file's up axis: "y" or "z"
  double size_m = 0.16;         // largest extent
  Eigen::Vector3d object_centre_in_table_m = Eigen::Vector3d::Zero();
  double scan_deviation_rms_m = 1e-4;  // of the true surface from what a scanner delivers
  std::vector<std::string> materials{"clay", "red-phenolic", "two-layer-gold", "glaze"};  // 1 to 4, see sim/material.h

  // The point light, and how its arm is off the rig's description.
  Eigen::Array3d point_light_w_per_sr = Eigen::Array3d::Constant(10.0);
  Eigen::Vector3d arm_offset_m = Eigen::Vector3d::Zero();  // of the pivot
  double arm_azimuth_error_deg = 0.0, arm_elevation_error_deg = 0.0;

  Eigen::Array3d ring_flash_w_per_sr = Eigen::Array3d::Constant(5.0);  // of all emitters together
  int ring_flash_emitters = 32;
  Eigen::Array3d backlight_w_per_m2_sr = Eigen::Array3d::Constant(2.0);
  double backlight_distance_m = 1.6;                     // from the camera, along its axis
  Eigen::Vector2d backlight_size_m{0.8, 0.6};

  // The spheres: GGX metal.
  Eigen::Vector3d first_sphere_in_rig_m = Eigen::Vector3d::Zero();  // its centre
  Eigen::Vector3d sphere_line_direction_in_rig = Eigen::Vector3d::UnitY();
  double sphere_roughness = 0.025;
  Eigen::Array3d sphere_reflectance{0.56, 0.57, 0.58};

  // The sensor, as far as the rig's description does not say. Electrons = radiance * exposure * response.
  double response_e_per_s_per_radiance = 2e5;  // radiance in W/(m^2 sr)
  double dark_current_e_per_s = 2.0;           // at 20 degrees Celsius
  double dark_current_doubling_k = 7.0;
  double hot_pixel_fraction = 2e-4;
  double hot_pixel_current_e_per_s = 2000.0;  // mean, at 20 degrees Celsius
};

// toml: the table's text, with or without its [simulation] header. Throws BadInput naming `where` and the key.
SimulationSettings parse_simulation_settings(const std::string& toml_text, const std::string& where);

}  // namespace lumitexel
