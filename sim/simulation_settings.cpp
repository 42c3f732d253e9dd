#include "sim/simulation_settings.h"

#include <cmath>
#include <set>
#include <sstream>
#include <toml++/toml.h>

#include "drivers/error.h"

namespace lumitexel {
namespace {

// Reads keys that are there, checks their ranges, and remembers them, so that the ones left over can be refused.
class Table {
 public:
  Table(const toml::table& table, std::string where) : table_(table), where_(std::move(where)) {}

  void number(const char* key, double& value, double low, double high) {
    if (const toml::node* node = find(key)) value = checked(*node, key, low, high);
  }

  void whole(const char* key, int& value, int low, int high) {
    double read = value;
    number(key, read, low, high);
    if (read != std::floor(read)) fail(key, text_of(read), "a whole number");
    value = static_cast<int>(read);
  }

  void boolean(const char* key, bool& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_boolean()) fail(key, "neither true nor false", "true or false");
    value = **node->as_boolean();
  }

  template <class Vector>
  void numbers(const char* key, Vector& value, double low, double high) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != static_cast<std::size_t>(value.size())) {
      fail(key, "no such list", "a list of " + std::to_string(value.size()) + " numbers");
    }
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      value[i] = checked((*array)[static_cast<std::size_t>(i)], key, low, high);
    }
  }

  void text(const char* key, std::string& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_string()) fail(key, "no text", "a text in quotes");
    value = **node->as_string();
  }

  void texts(const char* key, std::vector<std::string>& value, std::size_t most) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const std::string expected = "a list of 1 to " + std::to_string(most) + " texts";
    const toml::array* array = node->as_array();
    if (array == nullptr || array->empty() || array->size() > most) fail(key, "no such list", expected);
    value.clear();
    for (const toml::node& entry : *array) {
      if (!entry.is_string()) fail(key, "an entry that is no text", expected);
      value.push_back(**entry.as_string());
    }
  }

  void refuse_the_rest() const {
    for (const auto& [key, node] : table_) {
      if (known_.contains(std::string(key.str()))) continue;
      std::string all;
      for (const std::string& known : known_) all += (all.empty() ? "" : ", ") + known;
      fail(std::string(key.str()), "unknown key", "one of " + all);
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what, const std::string& expected) const {
    throw BadInput(where_ + ": simulation." + key, what, expected);
  }

  static std::string text_of(double value) {
    std::ostringstream stream;
    stream << value;
    return stream.str();
  }

 private:
  const toml::node* find(const char* key) {
    known_.insert(key);
    return table_.get(key);
  }

  double checked(const toml::node& node, const char* key, double low, double high) const {
    const std::string expected = "a number from " + text_of(low) + " to " + text_of(high);
    if (!node.is_number()) fail(key, "no number", expected);
    const double value = *node.value<double>();
    if (!(value >= low && value <= high)) fail(key, text_of(value), expected);  // NaN fails as well
    return value;
  }

  const toml::table& table_;
  std::string where_;
  std::set<std::string> known_;
};

void read_object(Table& table, SimulationSettings& s) {
  table.text("object", s.object);
  table.text("object_up", s.object_up);
  if (s.object_up != "y" && s.object_up != "z") table.fail("object_up", "'" + s.object_up + "'", "\"y\" or \"z\"");
  table.number("size_m", s.size_m, 0.01, 1.0);
  table.numbers("object_centre_in_table_m", s.object_centre_in_table_m, -1.0, 1.0);
  table.number("scan_deviation_rms_m", s.scan_deviation_rms_m, 0.0, 0.01);
  table.texts("materials", s.materials, 4);
}

void read_lamps(Table& table, SimulationSettings& s) {
  table.numbers("point_light_w_per_sr", s.point_light_w_per_sr, 1e-3, 1e6);
  table.numbers("arm_offset_m", s.arm_offset_m, -0.05, 0.05);
  table.number("arm_azimuth_error_deg", s.arm_azimuth_error_deg, -5.0, 5.0);
  table.number("arm_elevation_error_deg", s.arm_elevation_error_deg, -5.0, 5.0);
  table.numbers("second_lamp_w_per_sr", s.second_lamp_w_per_sr, 0.0, 1e6);
  table.numbers("second_lamp_in_rig_m", s.second_lamp_in_rig_m, -20.0, 20.0);
  table.numbers("ring_flash_w_per_sr", s.ring_flash_w_per_sr, 1e-3, 1e6);
  table.whole("ring_flash_emitters", s.ring_flash_emitters, 1, 256);
  table.numbers("backlight_w_per_m2_sr", s.backlight_w_per_m2_sr, 0.0, 1e6);
  table.number("backlight_distance_m", s.backlight_distance_m, 0.1, 10.0);
  table.numbers("backlight_size_m", s.backlight_size_m, 0.01, 10.0);
  table.number("lamp_settle_s", s.lamp_settle_s, 0.0, 10.0);
  table.number("lamp_radius_m", s.lamp_radius_m, 0.0, 0.2);
  table.number("lamp_pattern_exponent", s.lamp_pattern_exponent, 0.0, 200.0);
  table.numbers("lamp_pattern_tilt_deg", s.lamp_pattern_tilt_deg, -45.0, 45.0);
  table.number("lamp_drift", s.lamp_drift, -0.9, 9.0);
  table.whole("lamp_drift_shots", s.lamp_drift_shots, 1, 1'000'000);
}

void read_displacements(Table& table, SimulationSettings& s) {
  table.number("lens_focal_error", s.lens_focal_error, -0.2, 0.2);
  table.numbers("lens_principal_error_px", s.lens_principal_error_px, -1000.0, 1000.0);
  table.numbers("lens_distortion_error", s.lens_distortion_error, -1.0, 1.0);
  table.numbers("camera_position_error_m", s.camera_position_error_m, -0.1, 0.1);
  table.numbers("camera_rotation_error_deg", s.camera_rotation_error_deg, -10.0, 10.0);
  table.numbers("table_axis_point_error_m", s.table_axis_point_error_m, -0.1, 0.1);
  table.numbers("table_axis_tilt_deg", s.table_axis_tilt_deg, -10.0, 10.0);
  table.numbers("object_shift_m", s.object_shift_m, -1.0, 1.0);
  table.numbers("object_turn_deg", s.object_turn_deg, -180.0, 180.0);
  table.numbers("card_shift_m", s.card_shift_m, -0.1, 0.1);
  table.numbers("card_turn_deg", s.card_turn_deg, -30.0, 30.0);
}

void read_lens_targets(Table& table, SimulationSettings& s) {
  table.numbers("vignetting", s.vignetting, -2.0, 2.0);
  // At the far corner r is at most 2, with the principal point in the opposite one; what matters is the picture's.
  for (int i = 1; i <= 10; ++i) {
    const double r2 = 0.01 * i * i;
    if (1.0 + r2 * (s.vignetting[0] + r2 * (s.vignetting[1] + r2 * s.vignetting[2])) > 0.0) continue;
    table.fail("vignetting", "no light left at r = " + Table::text_of(0.1 * i), "a factor above 0 up to r = 1");
  }
  table.numbers("flat_field_w_per_m2_sr", s.flat_field_w_per_m2_sr, 1e-6, 1e6);
  table.whole("board_outlier_placements", s.board_outlier_placements, 0, 100);
  table.number("board_bow_m", s.board_bow_m, -0.05, 0.05);
  table.boolean("tags_clear_to_backlight", s.tags_clear_to_backlight);
}

void read_spheres(Table& table, SimulationSettings& s) {
  table.numbers("first_sphere_in_rig_m", s.first_sphere_in_rig_m, -2.0, 2.0);
  table.numbers("sphere_line_direction_in_rig", s.sphere_line_direction_in_rig, -1.0, 1.0);
  if (s.sphere_line_direction_in_rig.norm() < 0.1) {
    table.fail("sphere_line_direction_in_rig", "no direction", "a vector that is not zero");
  }
  s.sphere_line_direction_in_rig.normalize();
  table.number("sphere_roughness", s.sphere_roughness, 0.005, 0.5);
  table.numbers("sphere_reflectance", s.sphere_reflectance, 0.0, 1.0);
}

void read_sensor(Table& table, SimulationSettings& s) {
  table.number("response_e_per_s_per_radiance", s.response_e_per_s_per_radiance, 1e-3, 1e12);
  table.number("dark_current_e_per_s", s.dark_current_e_per_s, 0.0, 1e5);
  table.number("dark_current_doubling_k", s.dark_current_doubling_k, 1.0, 100.0);
  table.number("sensor_temperature_c", s.sensor_temperature_c, -50.0, 80.0);
  table.number("hot_pixel_fraction", s.hot_pixel_fraction, 0.0, 0.1);
  table.number("hot_pixel_current_e_per_s", s.hot_pixel_current_e_per_s, 0.0, 1e7);
  table.number("sensor_warming_k", s.sensor_warming_k, -50.0, 50.0);
  table.whole("sensor_warming_shots", s.sensor_warming_shots, 1, 1'000'000);
  std::string response = to_string(s.response);
  table.text("sensor_response", response);
  const std::optional<SensorResponse> named = sensor_response_named(response);
  if (!named) table.fail("sensor_response", "'" + response + "'", "linear, gamma or log-shoulder");
  s.response = *named;
  table.boolean("state_strip", s.state_strip);
}

void read_mechanics(Table& table, SimulationSettings& s) {
  table.number("turntable_backlash_deg", s.turntable_backlash_deg, 0.0, 5.0);
  table.number("turntable_swing_deg", s.turntable_swing_deg, 0.0, 5.0);
  table.number("turntable_swing_decay_s", s.turntable_swing_decay_s, 1e-3, 10.0);
  table.number("turntable_swing_hz", s.turntable_swing_hz, 0.1, 100.0);
}

toml::table parsed(const std::string& toml_text, const std::string& where) {
  try {
    toml::table root = toml::parse(toml_text);
    if (const toml::table* inner = root["simulation"].as_table()) return *inner;
    return root;
  } catch (const toml::parse_error& error) {
    throw BadInput(where + ": [simulation]", std::string(error.description()), "TOML");
  }
}

}  // namespace

SimulationSettings parse_simulation_settings(const std::string& toml_text, const std::string& where) {
  const toml::table root = parsed(toml_text, where);
  Table table(root, where);
  SimulationSettings settings;
  int seed = 1;
  table.whole("seed", seed, 0, 2'000'000'000);
  settings.seed = static_cast<std::uint64_t>(seed);
  table.whole("samples_per_pixel", settings.samples_per_pixel, 1, 256);
  const int side = static_cast<int>(std::lround(std::sqrt(settings.samples_per_pixel)));
  if (side * side != settings.samples_per_pixel) {
    table.fail("samples_per_pixel", std::to_string(settings.samples_per_pixel), "a square number: 1, 4, 9, …");
  }
  read_object(table, settings);
  read_lamps(table, settings);
  read_displacements(table, settings);
  read_lens_targets(table, settings);
  read_spheres(table, settings);
  read_sensor(table, settings);
  read_mechanics(table, settings);
  table.refuse_the_rest();
  return settings;
}

}  // namespace lumitexel
