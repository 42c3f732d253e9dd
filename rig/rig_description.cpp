#include "rig/rig_description.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "drivers/error.h"
#include "rig/toml_table.h"

namespace lumitexel {
namespace {

constexpr int kMostPixels = 65535;  // along an edge; keeps width * height * 2 far inside 64 bits
constexpr double kParallelSine = 1e-6;
constexpr int kTagIds = 587;             // of the family tag36h11
constexpr int kMostBoardCells = 200;     // along a side
constexpr double kTagWithMargin = 1.25;  // its ten cells against the eight inside the margin

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

Eigen::Vector3d vector3(const TomlTable& table, const std::string& key) {
  const std::vector<double> values = table.numbers(key, 3, NumberRange::finite());
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d direction(const TomlTable& table, const std::string& key) {
  const Eigen::Vector3d value = vector3(table, key);
  if (value.norm() < 1e-9) table.reject(key, "a vector without a direction", "a vector that is not zero");
  return value.normalized();
}

void reject_parallel(const TomlTable& table, const std::string& key, const Eigen::Vector3d& up,
                     const Eigen::Vector3d& axis, const std::string& axis_name) {
  if (up.cross(axis).norm() < kParallelSine) {
    table.reject(key, "parallel to " + axis_name, "a direction that differs from " + axis_name);
  }
}

void read_choices(const TomlTable& table, CameraLimits& limits) {
  if (!table.has("exposure_choices_s")) return;
  limits.exposure_choices_s = table.numbers(
      "exposure_choices_s", 0, NumberRange::between(limits.exposure_min_s, limits.exposure_max_s));
  if (!std::is_sorted(limits.exposure_choices_s.begin(), limits.exposure_choices_s.end(), std::less_equal<>())) {
    table.reject("exposure_choices_s", "not ascending", "each longer than the one before");
  }
}

void read_gain(const TomlTable& table, CameraLimits& limits) {
  if (table.has("gain_range_db")) {
    const std::vector<double> range = table.numbers("gain_range_db", 2, NumberRange::between(-60.0, 120.0));
    if (range[0] > range[1]) table.reject("gain_range_db", "not ascending", "[smallest, largest]");
    limits.gain_min_db = range[0];
    limits.gain_max_db = range[1];
  }
  if (table.has("gain_step_db")) limits.gain_step_db = table.number("gain_step_db", NumberRange::between(0.0, 60.0));
}

CameraLimits read_limits(const TomlTable& table) {
  CameraLimits limits;
  limits.width_px = table.integer("width_px", 1, kMostPixels);
  limits.height_px = table.integer("height_px", 1, kMostPixels);
  limits.bits = table.integer("bits", 1, 16);
  try {
    limits.mosaic = mosaic_from_string(table.string("mosaic"));
  } catch (const BadInput&) {
    table.reject("mosaic", table.string("mosaic"), "mono, rggb, bggr, grbg or gbrg");
  }
  limits.exposure_min_s = table.number("exposure_min_s", NumberRange::positive());
  limits.exposure_max_s = table.number("exposure_max_s", NumberRange::positive());
  if (limits.exposure_max_s < limits.exposure_min_s) {
    table.reject("exposure_max_s", std::to_string(limits.exposure_max_s), "at least exposure_min_s");
  }
  limits.exposure_step_s = table.number("exposure_step_s", NumberRange::between(0.0, limits.exposure_max_s));
  limits.readout_s = table.number("readout_s", NumberRange::non_negative());
  read_choices(table, limits);
  read_gain(table, limits);
  if (table.has("settings_latency_frames")) {
    limits.settings_latency_frames = table.integer("settings_latency_frames", 0, 100);
  }
  return limits;
}

LensDescription read_lens(const TomlTable& table, const CameraLimits& limits) {
  const std::vector<double> focal = table.numbers("focal_px", 2, NumberRange::positive());
  const std::vector<double> principal = table.numbers("principal_px", 2, NumberRange::finite());
  const std::vector<double> distortion = table.numbers("distortion", 4, NumberRange::finite());
  const auto sigma = [&](const std::string& key, double otherwise_px) {
    return table.has(key) ? table.number(key, NumberRange::positive()) : otherwise_px;
  };
  constexpr double kFocal = 0.01, kPrincipal = 0.01, kDistortion = 0.005;
  return {focal[0],
          focal[1],
          principal[0],
          principal[1],
          distortion[0],
          distortion[1],
          distortion[2],
          distortion[3],
          sigma("focal_sigma_px", kFocal * 0.5 * (focal[0] + focal[1])),
          sigma("principal_sigma_px", kPrincipal * limits.width_px),
          sigma("distortion_sigma_px", kDistortion * 0.5 * std::hypot(limits.width_px, limits.height_px))};
}

SensorDescription read_sensor(const TomlTable& table, int bits) {
  SensorDescription sensor;
  sensor.electrons_per_dn = table.number("electrons_per_dn", NumberRange::positive());
  sensor.full_well_e = table.number("full_well_e", NumberRange::positive());
  sensor.read_noise_e = table.number("read_noise_e", NumberRange::non_negative());
  // A black level at the top of the range would leave no code for light.
  sensor.black_level_dn = table.number("black_level_dn", NumberRange::between(0.0, std::ldexp(1.0, bits) - 2.0));
  return sensor;
}

Eigen::Isometry3d read_camera_pose(const TomlTable& table) {
  const Eigen::Vector3d position = vector3(table, "position_in_rig_m");
  const Eigen::Vector3d target = vector3(table, "looks_at_in_rig_m");
  const Eigen::Vector3d up = direction(table, "up_in_rig");
  if ((target - position).norm() < 1e-9) {
    table.reject("looks_at_in_rig_m", "the camera's own position", "a point in front of the camera");
  }
  const Eigen::Vector3d forward = (target - position).normalized();
  reject_parallel(table, "up_in_rig", up, forward, "the viewing direction");
  const Eigen::Vector3d right = forward.cross(up).normalized();
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  Eigen::Isometry3d camera_from_rig = Eigen::Isometry3d::Identity();
  camera_from_rig.linear() = rotation;
  camera_from_rig.translation() = -rotation * position;
  return camera_from_rig;
}

CameraDescription read_camera(const TomlTable& table) {
  CameraDescription camera;
  camera.limits = read_limits(table);
  camera.lens = read_lens(table, camera.limits);
  camera.sensor = read_sensor(table, camera.limits.bits);
  camera.camera_from_rig = read_camera_pose(table);
  table.reject_unread();
  return camera;
}

TurntableDescription read_turntable(const TomlTable& table) {
  TurntableDescription turntable;
  turntable.axis_point_in_rig = vector3(table, "axis_point_in_rig_m");
  turntable.axis_direction_in_rig = direction(table, "axis_direction_in_rig");
  turntable.speed_deg_per_s = table.number("speed_deg_per_s", NumberRange::positive());
  turntable.settle_s = table.number("settle_s", NumberRange::non_negative());
  table.reject_unread();
  return turntable;
}

LightPositionerDescription read_light_positioner(const TomlTable& table) {
  LightPositionerDescription arm;
  arm.pivot_in_rig = vector3(table, "pivot_in_rig_m");
  arm.radius_m = table.number("radius_m", NumberRange::positive());
  const auto range = [&](const std::string& key, double limit) {
    const std::vector<double> values = table.numbers(key, 2, NumberRange::between(-limit, limit));
    if (values[0] >= values[1]) table.reject(key, "not ascending", "[smallest, largest]");
    return values;
  };
  const std::vector<double> azimuth = range("azimuth_range_deg", 180.0);
  const std::vector<double> elevation = range("elevation_range_deg", 90.0);
  arm.azimuth_min_deg = azimuth[0];
  arm.azimuth_max_deg = azimuth[1];
  arm.elevation_min_deg = elevation[0];
  arm.elevation_max_deg = elevation[1];
  arm.speed_deg_per_s = table.number("speed_deg_per_s", NumberRange::positive());
  arm.settle_s = table.number("settle_s", NumberRange::non_negative());
  if (table.has("lamp_radius_m")) arm.lamp_radius_m = table.number("lamp_radius_m", NumberRange::between(0.0, 0.2 * arm.radius_m));
  table.reject_unread();
  return arm;
}

SphereLineDescription read_spheres(const TomlTable& table) {
  SphereLineDescription spheres;
  spheres.count = table.integer("count", 1, 1000);
  spheres.radius_m = table.number("radius_m", NumberRange::positive());
  spheres.spacing_m = table.number("spacing_m", NumberRange::positive());
  if (spheres.spacing_m < 2.0 * spheres.radius_m) {
    table.reject("spacing_m", std::to_string(spheres.spacing_m), "at least 2 * radius_m: spheres cannot overlap");
  }
  table.reject_unread();
  return spheres;
}

TagDescription read_tag(const TomlTable& table) {
  TagDescription tag;
  tag.id = table.integer("id", 0, kTagIds - 1);
  tag.size_m = table.number("size_m", NumberRange::positive());
  const std::string frame = table.string("frame");
  if (frame != "table" && frame != "rig") table.reject("frame", frame, "table or rig");
  tag.on_table = frame == "table";
  tag.centre = vector3(table, "centre_m");
  tag.normal = direction(table, "normal");
  const Eigen::Vector3d up = direction(table, "up");
  reject_parallel(table, "up", up, tag.normal, "normal");
  tag.up = (up - tag.normal * tag.normal.dot(up)).normalized();
  table.reject_unread();
  return tag;
}

std::vector<TagDescription> read_tags(const TomlTable& rig) {
  std::vector<TagDescription> tags;
  std::set<int> ids;
  for (const TomlTable& entry : rig.tables("tags")) {
    tags.push_back(read_tag(entry));
    if (!ids.insert(tags.back().id).second) {
      entry.reject("id", std::to_string(tags.back().id) + " for a second time", "an id of its own for every tag");
    }
  }
  return tags;
}

std::vector<int> read_tag_ids(const TomlTable& card, const std::vector<TagDescription>& tags) {
  std::vector<int> ids;
  for (const double number : card.numbers("tag_ids", 0, NumberRange::finite())) {
    const auto named = std::find_if(tags.begin(), tags.end(), [&](const TagDescription& tag) { return tag.id == number; });
    if (named == tags.end() || named->on_table) {
      card.reject("tag_ids", std::to_string(number), "ids of [[tags]] with frame = \"rig\"");
    }
    ids.push_back(named->id);
  }
  return ids;
}

GrayCardDescription read_gray_card(const TomlTable& table, const std::vector<TagDescription>& tags) {
  GrayCardDescription card;
  card.albedo = table.number("albedo", NumberRange::between(1e-6, 1.0));
  card.size_m = table.number("size_m", NumberRange::positive());
  card.centre_in_rig = vector3(table, "centre_in_rig_m");
  card.normal_in_rig = direction(table, "normal_in_rig");
  card.up_in_rig = direction(table, "up_in_rig");
  reject_parallel(table, "up_in_rig", card.up_in_rig, card.normal_in_rig, "normal_in_rig");
  if (table.has("tag_ids")) card.tag_ids = read_tag_ids(table, tags);
  table.reject_unread();
  return card;
}

BoardDescription::Pattern read_pattern(const TomlTable& table) {
  const std::string name = table.string("pattern");
  if (name == "checkerboard") return BoardDescription::Pattern::Checkerboard;
  if (name == "tag_grid") return BoardDescription::Pattern::TagGrid;
  table.reject("pattern", name, "checkerboard or tag_grid");
}

void read_tag_grid(const TomlTable& table, BoardDescription& board) {
  board.tag_size_m = table.number("tag_size_m", NumberRange::positive());
  if (board.tag_size_m * kTagWithMargin > board.pitch_m) {
    table.reject("tag_size_m", std::to_string(board.tag_size_m), "at most 0.8 * pitch_m: a tag needs its white margin");
  }
  board.first_tag_id = table.integer("first_tag_id", 0, kTagIds - 1);
  if (board.first_tag_id + board.columns * board.rows > kTagIds) {
    table.reject("first_tag_id", std::to_string(board.first_tag_id),
                 "ids up to " + std::to_string(kTagIds - 1) + " for all columns * rows tags");
  }
}

BoardDescription read_board(const TomlTable& table) {
  BoardDescription board;
  board.pattern = read_pattern(table);
  board.columns = table.integer("columns", 1, kMostBoardCells);
  board.rows = table.integer("rows", 1, kMostBoardCells);
  board.pitch_m = table.number("pitch_m", NumberRange::positive());
  board.albedo = table.number("albedo", NumberRange::between(0.1, 1.0));
  if (board.pattern == BoardDescription::Pattern::TagGrid) read_tag_grid(table, board);
  table.reject_unread();
  return board;
}

}  // namespace

std::array<Eigen::Vector3d, 4> TagDescription::corners() const {
  const Eigen::Vector3d right = 0.5 * size_m * up.cross(normal), top = 0.5 * size_m * up;
  return {centre - right - top, centre + right - top, centre + right + top, centre - right + top};
}

Eigen::Isometry3d TurntableDescription::rig_from_table(double angle_deg) const {
  return Eigen::Translation3d(axis_point_in_rig) * Eigen::AngleAxisd(radians(angle_deg), axis_direction_in_rig) *
         Eigen::Translation3d(-axis_point_in_rig);
}

Eigen::Vector3d LightPositionerDescription::nominal_position_in_rig(double azimuth_deg, double elevation_deg) const {
  const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
  return pivot_in_rig + radius_m * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

RigDescription parse_rig(const std::string& toml_text, const std::string& where) {
  const TomlTable table = TomlTable::parse(toml_text, where);
  RigDescription rig;
  rig.name = table.string("name");
  rig.backend = table.string("backend");
  rig.camera = read_camera(table.table("camera"));
  rig.turntable = read_turntable(table.table("turntable"));
  rig.light_positioner = read_light_positioner(table.table("light_positioner"));
  const TomlTable ring = table.table("ring_flash");
  rig.ring_flash.radius_m = ring.number("radius_m", NumberRange::positive());
  ring.reject_unread();
  rig.spheres = read_spheres(table.table("spheres"));
  if (table.has("tags")) rig.tags = read_tags(table);
  if (table.has("board")) rig.board = read_board(table.table("board"));
  rig.gray_card = read_gray_card(table.table("gray_card"), rig.tags);
  if (table.has("hardware")) rig.hardware_toml = table.text_of("hardware");
  if (table.has("recorded")) {
    const TomlTable recorded = table.table("recorded");
    rig.recorded_session = recorded.string("session");
    recorded.reject_unread();
  }
  if (table.has("simulation")) rig.simulation_toml = table.text_of("simulation");
  table.reject_unread();
  return rig;
}

}  // namespace lumitexel
