// A plate above a floor, its edge over x = 0, and a lamp of some size straight above: the penumbra's borders in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"
#include "processing/surface/view_geometry.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

constexpr double kPlate_m = 0.1, kLamp_m = 1.0, kRadius_m = 0.1;
// A ray from (x, 0) to the lamp's place u passes the plate's height at x (1 - h) + u h, with h = kPlate_m / kLamp_m.
constexpr double kBorder_m = kRadius_m * kPlate_m / (kLamp_m - kPlate_m);

void add_rectangle(Mesh& mesh, const Eigen::Vector3d& corner, double width_m, double depth_m, int cells) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto stride = static_cast<std::uint32_t>(cells + 1);
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      mesh.positions.push_back(corner + Eigen::Vector3d(width_m * i / cells, depth_m * j / cells, 0.0));
      mesh.normals.push_back(Eigen::Vector3d::UnitZ());
    }
  }
  for (std::uint32_t j = 0; j + 1 < stride; ++j) {
    for (std::uint32_t i = 0; i + 1 < stride; ++i) {
      const std::uint32_t a = first + j * stride + i;
      mesh.triangles.push_back({a, a + 1, a + stride + 1});
      mesh.triangles.push_back({a, a + stride + 1, a + stride});
    }
  }
}

Mesh plate_over_floor() {
  Mesh mesh;
  add_rectangle(mesh, {-0.1, -0.1, 0.0}, 0.2, 0.2, 40);
  add_rectangle(mesh, {-0.6, -0.6, kPlate_m}, 0.6, 1.2, 1);
  return mesh;
}

// Straight above the plate's edge, facing down, its rim's first place turned from x by `turn_rad`.
Light lamp_above(double radius_m, double turn_rad = 0.0) {
  Light light;
  light.vector_in_world = {0.0, 0.0, kLamp_m};
  light.intensity = {10.0, 10.0, 10.0};
  light.radius_m = radius_m;
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  light.lamp_from_world << c, s, 0.0, s, -c, 0.0, 0.0, 0.0, -1.0;
  return light;
}

Lighting at(const RayScene& scene, const Light& light, double x_m, double y_m) {
  return lighting_of(light, {{x_m, y_m, 0.0}, Eigen::Vector3d::UnitZ()}, scene);
}

TEST(Penumbra, HasItsBordersWhereGeometryPutsThem) {
  const RayScene scene(plate_over_floor());
  for (const double y : {-0.08, -0.01, 0.0, 0.05}) {
    for (const double off : {1e-4, 1e-3, 5e-3}) {
      EXPECT_EQ(at(scene, lamp_above(kRadius_m), kBorder_m + off, y), Lighting::Full);
      EXPECT_EQ(at(scene, lamp_above(kRadius_m), kBorder_m - off, y), Lighting::Partly);
      EXPECT_EQ(at(scene, lamp_above(kRadius_m), -kBorder_m + off, y), Lighting::Partly);
      EXPECT_EQ(at(scene, lamp_above(kRadius_m), -kBorder_m - off, y), Lighting::Dark);
    }
  }
}

// With no place of the rim at the very side the border lies where the nearest two have it: 8 % of the radius are missed at most.
TEST(Penumbra, IsMissedByLittleBetweenTheRimsPlaces) {
  const RayScene scene(plate_over_floor());
  const Light lamp = lamp_above(kRadius_m, std::numbers::pi / kRimPlaces);
  const double nearest = std::cos(std::numbers::pi / kRimPlaces);
  EXPECT_GT(nearest, 0.92);
  EXPECT_EQ(at(scene, lamp, 1.01 * nearest * kBorder_m, 0.0), Lighting::Full);
  EXPECT_EQ(at(scene, lamp, 0.99 * nearest * kBorder_m, 0.0), Lighting::Partly);
}

TEST(Penumbra, APointHasNone) {
  const RayScene scene(plate_over_floor());
  EXPECT_EQ(at(scene, lamp_above(0.0), 1e-4, 0.0), Lighting::Full);
  EXPECT_EQ(at(scene, lamp_above(0.0), -1e-4, 0.0), Lighting::Dark);
}

// Samples on the floor by where they are, and their reflectance.
std::map<std::pair<double, double>, float> floor_samples(const GatheredLumitexels& gathered) {
  std::map<std::pair<double, double>, float> samples;
  for (const LumitexelTile& tile : gathered.set.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile.position[i].z() > 0.5 * kPlate_m || tile.first_sample[i] == tile.first_sample[i + 1]) continue;
      samples[{tile.position[i].x(), tile.position[i].y()}] = tile.reflectance[3 * tile.first_sample[i]];
    }
  }
  return samples;
}

GatheredLumitexels gathered_under(double radius_m, const TemporaryFolder& folder) {
  View view = view_of_origin("above", {0.5, 0.0, 0.5}, {0.0, 0.0, kLamp_m});
  view.light = lamp_above(radius_m);
  const CalibratedSession session = diffuse_session(plate_over_floor(), {view}, folder);
  const RayScene scene(session.mesh);
  const Atlas atlas = make_atlas(session, choose_best_views(session, scene));
  NoProgress progress;
  return gather_lumitexels(session, atlas, scene, progress);
}

TEST(Penumbra, GivesNoSamplesAndIsCounted) {
  const TemporaryFolder folder;
  const GatheredLumitexels by_point = gathered_under(0.0, folder), by_disc = gathered_under(kRadius_m, folder);
  EXPECT_EQ(by_point.rejected.in_penumbra, 0);
  EXPECT_GT(by_disc.rejected.in_penumbra, 100);
  const auto point = floor_samples(by_point), disc = floor_samples(by_disc);
  std::size_t in_penumbra = 0, well_outside = 0;
  constexpr double kMargin_m = 0.008;  // kEdgeMarginPx and a pixel more, as the floor is seen
  for (const auto& [place, reflectance] : point) {
    in_penumbra += place.first < kBorder_m;
    const auto same = disc.find(place);
    if (place.first > kBorder_m + kMargin_m) {
      ++well_outside;
      ASSERT_NE(same, disc.end()) << place.first;
      EXPECT_EQ(same->second, reflectance);
    }
  }
  EXPECT_GT(in_penumbra, 20u);  // what a lamp taken for a point would have used
  EXPECT_GT(well_outside, 500u);
  for (const auto& sample : disc) EXPECT_GT(sample.first.first, kBorder_m);
}

}  // namespace
}  // namespace lumitexel
