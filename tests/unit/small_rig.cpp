#include "tests/unit/small_rig.h"

#include <gtest/gtest.h>

namespace lumitexel {

std::string small_rig_toml() {
  return R"toml(name = "small bench"
backend = "simulated"

[camera]
width_px = 6
height_px = 4
bits = 12
mosaic = "rggb"
exposure_min_s = 1e-5
exposure_max_s = 30.0
exposure_step_s = 1e-6
readout_s = 0.15
focal_px = [20.0, 21.0]
principal_px = [3.0, 2.0]
distortion = [-0.08, 0.15, 0.0004, -0.0003]
electrons_per_dn = 1.2
full_well_e = 18000
read_noise_e = 4.0
black_level_dn = 64.0
position_in_rig_m = [1.0, 0.0, 0.5]
looks_at_in_rig_m = [0.0, 0.0, 0.0]
up_in_rig = [0.0, 0.0, 1.0]

[turntable]
axis_point_in_rig_m = [0.1, 0.0, 0.0]
axis_direction_in_rig = [0.0, 0.0, 2.0]
speed_deg_per_s = 20.0
settle_s = 0.5

[light_positioner]
pivot_in_rig_m = [0.0, 0.0, 0.1]
radius_m = 2.0
azimuth_range_deg = [-110.0, 110.0]
elevation_range_deg = [-20.0, 85.0]
speed_deg_per_s = 15.0
settle_s = 0.8

[ring_flash]
radius_m = 0.04

[spheres]
count = 6
radius_m = 0.020
spacing_m = 0.050

[gray_card]
albedo = 0.18
size_m = 0.04
centre_in_rig_m = [0.05, -0.13, -0.075]
normal_in_rig = [0.8, 0.1, 0.6]
up_in_rig = [0.0, 0.0, 1.0]
)toml";
}

std::string small_plan_toml() {
  return R"toml(name = "three views"
mesh = "scan"
gain_db = 0
darks_per_exposure = 2

views = [
  { name = "fit_000", split = "fit", turntable_deg = 10.0, light_azimuth_deg = 20.0, light_elevation_deg = 30.0 },
  { name = "fit_001", split = "fit", turntable_deg = 350.0, light_azimuth_deg = 20.0, light_elevation_deg = 30.0 },
  { name = "heldout_000", split = "heldout", turntable_deg = 30.0, light_azimuth_deg = -5.0, light_elevation_deg = 40.0 },
]

[exposures]
bracket_s = [0.01, 0.08]
gray_card_s = [0.08, 0.64]
silhouette_s = 0.02
spheres_ring_s = 0.01
spheres_point_s = 0.001

[gray_card]
light_azimuth_deg = -5.0
light_elevation_deg = 40.0
)toml";
}

RigDescription small_rig() { return parse_rig(small_rig_toml(), "rig.toml"); }
CapturePlan small_plan() { return parse_plan(small_plan_toml(), "plan.toml"); }

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "no '" << from << "' to replace";
    return text;
  }
  return text.replace(at, from.size(), to);
}

}  // namespace lumitexel
