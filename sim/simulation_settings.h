// The [simulation] table of a rig: what only the simulated world knows. Every key has a unit in its name and a range;
// a key that is missing takes the default below, a key that is not listed here is an error.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/bench_behaviour.h"
#include "sim/sensor_response.h"

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

  double lamp_radius_m = 0.0;            // of its disc; 0: a point
  double lamp_pattern_exponent = 0.0;    // its intensity goes with the cosine to its axis to this power
  Eigen::Vector2d lamp_pattern_tilt_deg = Eigen::Vector2d::Zero();  // of that axis (sim/point_lamp.h)

  // Another light that goes on and off with the point light: a second head on its switch, or its image in something polished.
  Eigen::Array3d second_lamp_w_per_sr = Eigen::Array3d::Zero();  // 0: there is none
  Eigen::Vector3d second_lamp_in_rig_m = Eigen::Vector3d::Zero();

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

  // How the rest is off the rig's description (sim/true_rig.h). Turns are rotation vectors.
  double lens_focal_error = 0.0;  // relative
  Eigen::Vector2d lens_principal_error_px = Eigen::Vector2d::Zero();
  Eigen::Vector4d lens_distortion_error = Eigen::Vector4d::Zero();           // k1, k2, p1, p2
  Eigen::Vector3d camera_position_error_m = Eigen::Vector3d::Zero();         // in the rig's frame
  Eigen::Vector3d camera_rotation_error_deg = Eigen::Vector3d::Zero();       // in the camera's frame
  Eigen::Vector3d table_axis_point_error_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d table_axis_tilt_deg = Eigen::Vector2d::Zero();             // about the rig's x, then y
  Eigen::Vector3d object_shift_m = Eigen::Vector3d::Zero();                  // where the operator put the object:
  Eigen::Vector3d object_turn_deg = Eigen::Vector3d::Zero();                 // x_in_table = turn * x_in_mesh + shift
  Eigen::Vector3d card_shift_m = Eigen::Vector3d::Zero();                    // the gray card and its tags,
  Eigen::Vector3d card_turn_deg = Eigen::Vector3d::Zero();                   // turned about the card's centre

  // What the lens calibration photographs.
  Eigen::Vector3d vignetting = Eigen::Vector3d::Zero();  // a, b, c of 1 + a r^2 + b r^4 + c r^6 (sim/true_rig.h)
  Eigen::Array3d flat_field_w_per_m2_sr = Eigen::Array3d::Constant(0.8);
  int board_outlier_placements = 0;  // in so many placements the board is bent
  double board_bow_m = 0.003;        // by so much

  // Tags whose ink and paper let the backlight through, so that silhouettes do not show them.
  bool tags_clear_to_backlight = false;

  // The sensor, as far as the rig's description does not say. Electrons = radiance * exposure * response.
  double response_e_per_s_per_radiance = 2e5;  // radiance in W/(m^2 sr)
  double dark_current_e_per_s = 2.0;           // at 20 degrees Celsius
  double dark_current_doubling_k = 7.0;
  double hot_pixel_fraction = 2e-4;
  double hot_pixel_current_e_per_s = 2000.0;  // mean, at 20 degrees Celsius
  SensorResponse response = SensorResponse::Linear;  // "sensor_response"
};

// toml: the table's text, with or without its [simulation] header. Throws BadInput naming `where` and the key.
SimulationSettings parse_simulation_settings(const std::string& toml_text, const std::string& where);

}  // namespace lumitexel
