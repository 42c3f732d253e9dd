#include "tests/unit/worth/true_views.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "rig/whole_file.h"
#include "sim/placed_scene.h"
#include "sim/point_lamp.h"
#include "sim/render_radiance.h"
#include "sim/true_rig.h"

namespace lumitexel {
namespace {

double samples_per_radiance(const SimulatedWorld& world) {
  return world.settings.response_e_per_s_per_radiance / world.rig.camera.sensor.electrons_per_dn;
}

// In a frame whose z is the lamp's true axis the pattern has no tilt.
Light true_light(const SimulatedWorld& world, const PlannedView& planned, const Eigen::Isometry3d& mesh_from_rig,
                 double strength) {
  const Emitter lamp = point_lamp_in_rig(world, planned.light_azimuth_deg, planned.light_elevation_deg).front().in(mesh_from_rig);
  Light light;
  light.vector_in_world = lamp.position;
  for (const double w_per_sr : lamp.w_per_sr) light.intensity.push_back(strength * samples_per_radiance(world) * w_per_sr);
  light.pattern = LampPattern({lamp.exponent, 0.0, 0.0, 0.0}, Eigen::Matrix4d::Zero());
  light.lamp_from_world = Eigen::Quaterniond::FromTwoVectors(lamp.axis, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return light;
}

// The digits of i in the base, mirrored at the point.
double radical_inverse(int i, int base) {
  double value = 0.0, digit = 1.0 / base;
  for (; i > 0; i /= base, digit /= base) value += digit * (i % base);
  return value;
}

std::vector<std::uint8_t> object_pixels_of(const SimulatedWorld& world, double turntable_deg) {
  const PlacedScene scene(world, turntable_deg);
  const Eigen::Isometry3d mesh_from_camera = scene.mesh_from_rig() * world.rig.camera.camera_from_rig.inverse();
  std::vector<std::uint8_t> counted;
  for (int y = 0; y < world.camera.height_px; ++y) {
    for (int x = 0; x < world.camera.width_px; ++x) {
      const Eigen::Vector3d in_camera = world.camera.unproject(Eigen::Vector2d(x + 0.5, y + 0.5));
      const SceneHit hit = scene.closest(mesh_from_camera.translation(), mesh_from_camera.linear() * in_camera);
      counted.push_back(hit.part == ScenePart::Object);
    }
  }
  return counted;
}

}  // namespace

View true_view(const SimulatedWorld& world, const PlannedView& planned, double lamp_strength) {
  const Eigen::Isometry3d mesh_from_rig = world.mesh_from_rig(planned.turntable_deg);
  View view;
  view.name = planned.name;
  view.heldout = planned.heldout;
  view.camera = world.camera;
  view.camera_from_world = world.rig.camera.camera_from_rig * mesh_from_rig.inverse();
  view.light = true_light(world, planned, mesh_from_rig, lamp_strength);
  return view;
}

std::vector<View> session_as_it_was(const CapturedWorld& captured) {
  const std::filesystem::path file = captured.session.directory() / "truth" / "calibration.json";
  const auto lights = nlohmann::json::parse(read_whole_file(file)).at("lights");
  std::vector<View> views;
  for (std::size_t v = 0; v < captured.plan.views.size(); ++v) {
    const double w_per_sr = lights.at(v).at("intensity_w_per_sr").at(0);
    views.push_back(true_view(*captured.world, captured.plan.views[v], w_per_sr / captured.world->settings.point_light_w_per_sr[0]));
  }
  return views;
}

void take_truth(CalibratedSession& session, const std::vector<View>& as_it_was) {
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    std::filesystem::path photograph = std::move(session.views[v].photograph);
    session.views[v] = as_it_was[v];
    session.views[v].photograph = std::move(photograph);
  }
}

std::vector<TrueView> see_truly(const std::shared_ptr<const SimulatedWorld>& world, const std::vector<PlannedView>& wanted) {
  RadianceRenderer renderer(world);
  std::vector<TrueView> views;
  for (const PlannedView& planned : wanted) {
    WorldState state;
    state.turntable_deg = planned.turntable_deg;
    state.light_azimuth_deg = planned.light_azimuth_deg;
    state.light_elevation_deg = planned.light_elevation_deg;
    state.point_light = true;
    Image radiance = *renderer.render(state);
    for (int y = 0; y < radiance.height; ++y) {
      for (int x = 0; x < radiance.width; ++x) {
        const double factor = samples_per_radiance(*world) /
                              vignetting_at(world->rig.camera, world->settings.vignetting, x + 0.5, y + 0.5);
        for (int c = 0; c < radiance.channels; ++c) radiance.at(x, y, c) *= static_cast<float>(factor);
      }
    }
    views.push_back({true_view(*world, planned), std::move(radiance), object_pixels_of(*world, planned.turntable_deg)});
  }
  return views;
}

std::vector<PlannedView> spread_views(int count) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::vector<PlannedView> views;
  for (int i = 1; i <= count; ++i) {
    PlannedView& view = views.emplace_back();
    view.name = "spread_" + std::to_string(i);
    view.heldout = true;
    view.turntable_deg = 360.0 * radical_inverse(i, 2);
    view.light_azimuth_deg = 160.0 * radical_inverse(i, 3) - 80.0;
    view.light_elevation_deg = std::asin(std::sin(65.0 * kDegree) * radical_inverse(i, 5)) / kDegree;
  }
  return views;
}

}  // namespace lumitexel
