#include "sim/simulation_settings.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "bad_input_matcher.h"

namespace lumitexel {
namespace {

TEST(SimulationSettings, ReadsKeysWithAndWithoutTheHeaderAndKeepsDefaults) {
  for (const std::string header : {"", "[simulation]\n"}) {
    const SimulationSettings settings = parse_simulation_settings(
        header + "seed = 9\npoint_light_w_per_sr = [3, 2.5, 2]\nmaterials = ['copper']\nobject = 'x/spot.obj'", "rig");
    EXPECT_EQ(settings.seed, 9u);
    EXPECT_EQ(settings.point_light_w_per_sr[1], 2.5);
    EXPECT_EQ(settings.materials, std::vector<std::string>{"copper"});
    EXPECT_EQ(settings.object, "x/spot.obj");
    EXPECT_EQ(settings.samples_per_pixel, 4);
  }
}

TEST(SimulationSettings, RefusesWhatItDoesNotUnderstandAndNamesTheKey) {
  const std::pair<const char*, const char*> cases[] = {
      {"colour = 3", "simulation.colour"},
      {"seed = -1", "simulation.seed"},
      {"seed = 1.5", "simulation.seed"},
      {"samples_per_pixel = 5", "simulation.samples_per_pixel"},
      {"size_m = nan", "simulation.size_m"},
      {"size_m = '16 cm'", "simulation.size_m"},
      {"arm_offset_m = [0.1, 0, 0]", "simulation.arm_offset_m"},
      {"arm_offset_m = [0.01, 0]", "simulation.arm_offset_m"},
      {"sphere_line_direction_in_rig = [0, 0, 0]", "simulation.sphere_line_direction_in_rig"},
      {"materials = []", "simulation.materials"},
      {"materials = ['clay', 3]", "simulation.materials"},
      {"object_up = 'x'", "simulation.object_up"},
      {"hot_pixel_fraction = 2", "simulation.hot_pixel_fraction"},
      {"seed = ", "[simulation]"}};
  for (const auto& [toml, key] : cases) {
    EXPECT_BAD_INPUT(parse_simulation_settings(toml, "rig.toml"), std::string("rig.toml: ") + key) << toml;
  }
}

TEST(SimulationSettings, TheShippedBenchIsValid) {
  std::ifstream stream(LUMITEXEL_SOURCE_DIR "/config/rigs/simulated.toml");
  std::stringstream text;
  text << stream.rdbuf();
  const std::size_t table = text.str().find("[simulation]");
  ASSERT_NE(table, std::string::npos);
  const SimulationSettings settings = parse_simulation_settings(text.str().substr(table), "simulated.toml");
  EXPECT_EQ(settings.materials.size(), 4u);
}

}  // namespace
}  // namespace lumitexel
