// The world that the simulated devices move, light and photograph: built once, never changed. What changes is a WorldState.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/surface/mesh.h"
#include "processing/surface/ray_scene.h"
#include "rig/rig_description.h"
#include "sim/material.h"
#include "sim/printed_pattern.h"
#include "sim/simulation_settings.h"
#include "sim/surface_pattern.h"
#include "sim/world_state.h"

namespace lumitexel {

class SimulatedWorld {
 public:
  // Throws BadInput naming `where` for a material that does not exist, and what loaded_object throws.
  SimulatedWorld(const RigDescription& rig, const SimulationSettings& settings, const std::string& where);

  const RigDescription rig;  // as it really stands: the description, off by the settings' hidden errors
  const SimulationSettings settings;
  const CameraModel camera;
  // The true surface and what a scanner says of it, in the mesh's frame; the operator may have put it elsewhere on the
  // table. The truth's world is that frame.
  const Mesh object, scan;
  const Eigen::Isometry3d table_from_mesh;
  const RayScene object_rays;
  const std::vector<Material> materials;
  const SurfacePattern pattern;
  const std::vector<TagPattern> tag_patterns;  // of rig.tags

  Eigen::Isometry3d mesh_from_rig(double turntable_deg) const;
  // The truth behind LightPositionerDescription::nominal_position_in_rig.
  Eigen::Vector3d point_light_in_rig(double azimuth_deg, double elevation_deg) const;
  std::vector<Eigen::Vector3d> ring_emitters_in_rig() const;
  std::vector<Eigen::Vector3d> sphere_centres_in_rig() const;
};

}  // namespace lumitexel
