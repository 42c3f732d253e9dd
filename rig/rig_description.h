// What a rig consists of and where its parts stand: the TOML file that `lumitexel plan RIG PLAN` names.
//
// Frames: `rig` is the right-handed world of the bench, in metres. `table` turns with the turntable; at
// 0 degrees it coincides with `rig`. The object's mesh is given in `table`. The camera looks along its +z,
// y down. Angles are in degrees in files and at this interface.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/camera.h"

namespace lumitexel {

// Pinhole with Brown-Conrady distortion (OpenCV's k1, k2, p1, p2); the centre of the top-left pixel is at (0.5, 0.5).
struct LensDescription {
  double focal_x_px = 0, focal_y_px = 0, principal_x_px = 0, principal_y_px = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;
  // How far off these may be, one standard deviation each: of the focal lengths; of the principal point along x and y; of where
  // a distortion term puts the picture's corner. Not in the file: 1 % of the focal length (data sheets say 1 to 5 %, and
  // focusing changes it), 1 % of the width (sensors are mounted to a tenth of a millimetre), 0.5 % of half the diagonal
  // (what lenses for measurement are sold with).
  double focal_sigma_px = 0, principal_sigma_px = 0, distortion_sigma_px = 0;
};

// The noise model of a linear sensor; a sample is black_level + electrons / electrons_per_dn, rounded and clipped.
struct SensorDescription {
  double electrons_per_dn = 1.0;
  double full_well_e = 0.0;   // electrons at which a pixel saturates
  double read_noise_e = 0.0;  // standard deviation of one read
  double black_level_dn = 0.0;
};

struct CameraDescription {
  CameraLimits limits;
  LensDescription lens;
  SensorDescription sensor;
  Eigen::Isometry3d camera_from_rig = Eigen::Isometry3d::Identity();
};

struct TurntableDescription {
  Eigen::Vector3d axis_point_in_rig = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_direction_in_rig = Eigen::Vector3d::UnitZ();  // turning is right-handed about it
  double speed_deg_per_s = 0, settle_s = 0;
  // rig_from_table at this angle.
  Eigen::Isometry3d rig_from_table(double angle_deg) const;
};

// An arm with two joints that holds the point light on a sphere about a pivot. Nominal: where the light really
// is, the sphere shots tell.
struct LightPositionerDescription {
  Eigen::Vector3d pivot_in_rig = Eigen::Vector3d::Zero();
  double radius_m = 1.0;
  double azimuth_min_deg = -180, azimuth_max_deg = 180;     // about rig +z, from rig +x
  double elevation_min_deg = -90, elevation_max_deg = 90;  // above the rig's xy plane
  double speed_deg_per_s = 0, settle_s = 0;
  double lamp_radius_m = 0;  // of the lamp's evenly bright disc, which faces the pivot; 0 (not in the file): a point
  Eigen::Vector3d nominal_position_in_rig(double azimuth_deg, double elevation_deg) const;
};

// Mirror spheres of equal radius, their centres on a straight line at equal distances. Where the line lies is
// measured from the sphere shots, not given.
struct SphereLineDescription {
  int count = 0;
  double radius_m = 0, spacing_m = 0;
};

// A diffuse card that stands still in the rig, in the camera's sight.
struct GrayCardDescription {
  double albedo = 0.18;
  Eigen::Vector3d centre_in_rig = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_in_rig = Eigen::Vector3d::UnitZ();
  double size_m = 0;  // edge of the square
  Eigen::Vector3d up_in_rig = Eigen::Vector3d::UnitZ();  // an edge's direction
  // Tags fixed to the card's frame: where they stand against the card is known, where both stand in the rig roughly.
  std::vector<int> tag_ids = {};
};

// An AprilTag of the family tag36h11 that stands still in the rig or turns with the table.
struct TagDescription {
  int id = 0;
  double size_m = 0;      // edge of the square where the black border meets the white margin
  bool on_table = false;  // what follows is given in `table`; else in `rig`
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, out of the printed side
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();      // unit, normal to `normal`: towards the tag's upper edge as printed
  // The square's corners in the given frame: lower left, lower right, upper right, upper left, as printed.
  std::array<Eigen::Vector3d, 4> corners() const;
};

// A flat board to be photographed in many places for the lens. Its frame: origin at the pattern's centre, x along the
// columns to the right, y up along the rows, z out of the printed side.
struct BoardDescription {
  enum class Pattern { Checkerboard, TagGrid };
  Pattern pattern = Pattern::Checkerboard;
  int columns = 0, rows = 0;  // inner corners of a checkerboard; tags of a grid
  double pitch_m = 0;         // a square's edge; from a tag's centre to the next one's
  double tag_size_m = 0;      // TagDescription::size_m of the grid's tags
  int first_tag_id = 0;       // lower left; then along the row to the right, then the row above
  double albedo = 0;          // of the white parts
};

struct RingFlashDescription { double radius_m = 0; };  // a ring around the lens, in the camera's xy plane

struct RigDescription {
  std::string name;
  std::string backend;  // "simulated", "hardware" or "recorded"
  CameraDescription camera;
  TurntableDescription turntable;
  LightPositionerDescription light_positioner;
  RingFlashDescription ring_flash;
  SphereLineDescription spheres;
  GrayCardDescription gray_card;
  std::vector<TagDescription> tags;       // [[tags]]; may be empty
  std::optional<BoardDescription> board;  // [board]
  // The [simulation] table as TOML text, untouched: only the simulated world understands it. Empty if absent.
  std::string simulation_toml;
  // Likewise [hardware]: how the devices are connected (rig/hardware_description.h).
  std::string hardware_toml;
  // [recorded] session: the session that backend = "recorded" plays back; relative to the rig's file. Empty if absent.
  std::string recorded_session;
};

// Reads and checks a rig. `where` names the source in errors. Throws BadInput naming `where`, line and key for
// anything missing, unknown, of the wrong type or out of range.
RigDescription parse_rig(const std::string& toml_text, const std::string& where);

}  // namespace lumitexel
