#include "sim/simulated_world.h"

#include <cmath>
#include <numbers>

#include "processing/calibration/lens/rig_camera.h"
#include "sim/loaded_object.h"
#include "sim/procedural_object.h"
#include "sim/simulated_rig.h"
#include "sim/true_rig.h"

namespace lumitexel {
namespace {

VaseOptions vase_options(const SimulationSettings& settings) {
  return {settings.size_m, settings.object_centre_in_table_m, settings.scan_deviation_rms_m, settings.seed};
}

Mesh true_object(const SimulationSettings& settings, const std::string& where) {
  if (settings.object == "vase") return vase(vase_options(settings));
  const std::filesystem::path folder = std::filesystem::path(where).parent_path();
  return loaded_object(folder / settings.object, settings.object_up == "y", settings.size_m,
                       settings.object_centre_in_table_m);
}

std::vector<Material> named_materials(const SimulationSettings& settings, const std::string& where) {
  std::vector<Material> materials;
  for (const std::string& name : settings.materials) {
    materials.push_back(material_named(name, where + ": simulation.materials"));
  }
  return materials;
}

std::vector<TagPattern> printed_tags(const std::vector<TagDescription>& tags) {
  std::vector<TagPattern> patterns;
  for (const TagDescription& tag : tags) patterns.emplace_back(tag.id);
  return patterns;
}

double radians(double deg) { return deg * std::numbers::pi / 180.0; }

}  // namespace

SimulatedWorld::SimulatedWorld(const RigDescription& rig_description, const SimulationSettings& simulation_settings,
                               const std::string& where)
    : rig(true_rig(rig_description, simulation_settings)),
      settings(simulation_settings),
      camera(camera_model_of(rig.camera)),
      object(true_object(settings, where)),
      scan(settings.object == "vase" ? vase_scan(vase_options(settings))
                                     : smoothed(object, settings.scan_deviation_rms_m)),
      table_from_mesh(true_table_from_mesh(settings)),
      object_rays(object),
      materials(named_materials(settings, where)),
      pattern{settings.seed, static_cast<int>(materials.size()), settings.size_m},
      tag_patterns(printed_tags(rig.tags)) {}

Eigen::Isometry3d SimulatedWorld::mesh_from_rig(double turntable_deg) const {
  return (rig.turntable.rig_from_table(turntable_deg) * table_from_mesh).inverse();
}

Eigen::Vector3d SimulatedWorld::point_light_in_rig(double azimuth_deg, double elevation_deg) const {
  const double azimuth = radians(azimuth_deg + settings.arm_azimuth_error_deg);
  const double elevation = radians(elevation_deg + settings.arm_elevation_error_deg);
  const Eigen::Vector3d along(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
  return rig.light_positioner.pivot_in_rig + settings.arm_offset_m + rig.light_positioner.radius_m * along;
}

std::vector<Eigen::Vector3d> SimulatedWorld::ring_emitters_in_rig() const {
  const Eigen::Isometry3d rig_from_camera = rig.camera.camera_from_rig.inverse();
  std::vector<Eigen::Vector3d> emitters;
  for (int i = 0; i < settings.ring_flash_emitters; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / settings.ring_flash_emitters;
    emitters.push_back(rig_from_camera *
                       Eigen::Vector3d(rig.ring_flash.radius_m * std::cos(angle),
                                       rig.ring_flash.radius_m * std::sin(angle), 0.0));
  }
  return emitters;
}

std::vector<Eigen::Vector3d> SimulatedWorld::sphere_centres_in_rig() const {
  std::vector<Eigen::Vector3d> centres;
  for (int i = 0; i < rig.spheres.count; ++i) {
    centres.push_back(settings.first_sphere_in_rig_m +
                      i * rig.spheres.spacing_m * settings.sphere_line_direction_in_rig);
  }
  return centres;
}

std::shared_ptr<SimulatedWorld> build_world(const RigDescription& rig, const std::string& where) {
  return std::make_shared<SimulatedWorld>(rig, parse_simulation_settings(rig.simulation_toml, where), where);
}

Mesh scanned_mesh(const SimulatedWorld& world) { return world.scan; }

}  // namespace lumitexel
