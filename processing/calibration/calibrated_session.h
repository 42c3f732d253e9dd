// A session made ready to fit: every view's camera, pose, light and radiance, and the coarse mesh, in one frame.
//
// `world` is the frame of the mesh. For a captured session it is the turntable's frame, so that cameras and lights
// move and the object stands still. Point lights: intensity in W/sr (or any one scale) such that the irradiance at
// normal incidence is intensity / distance^2 in the unit of the photographs times pi; that is, an ideal diffuse
// surface has radiance albedo / pi * intensity * cos(theta) / distance^2. Directional: irradiance instead.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "processing/calibration/calibration_options.h"
#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/lamp_pattern.h"
#include "processing/image/radiance_image.h"
#include "processing/surface/mesh.h"
#include "rig/progress.h"
#include "rig/session_store.h"

namespace lumitexel {

struct Light {
  enum class Type { Point, Directional };
  Type type = Type::Point;
  Eigen::Vector3d vector_in_world = Eigen::Vector3d::Zero();  // position (m), or unit vector towards the light
  std::vector<double> intensity;                              // per channel; of a point light along its lamp's z
  double sigma_m = 0;                                         // one sigma of the position per axis; 0 if unknown
  // How a point light's intensity depends on direction; by default not at all.
  LampPattern pattern{};
  Eigen::Matrix3d lamp_from_world = Eigen::Matrix3d::Identity();  // turn of the lamp's frame (light/lamp_pattern.h)
  double radius_m = 0;  // of a point light's disc, which faces along its lamp's z; 0: a point, as far as is known

  // Unit vector from the surface point towards the light.
  Eigen::Vector3d direction_from(const Eigen::Vector3d& x_in_world) const;
  // Irradiance at normal incidence at the point, in channel c.
  double irradiance(const Eigen::Vector3d& x_in_world, int c) const;
};

struct View {
  std::string name;  // as in the session: "fit_000.exr" or the plan's view name
  bool heldout = false;
  CameraModel camera;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  Light light;
  std::filesystem::path photograph;  // of a RadianceImage

  Eigen::Vector3d camera_in_world() const { return camera_from_world.inverse().translation(); }
};

struct CalibrationSummary;  // calibration_summary.h

struct CalibratedSession {
  int channels = 3;
  std::vector<View> views;           // in the session's order, fit and held out mixed
  Mesh mesh;                         // the coarse mesh in `world`
  std::string key;                   // hash of the session's content and the calibration's options
  double gray_card_scale_sigma = 0;  // relative one-sigma of the absolute scale; 0 if unknown
};

// Runs what is needed (dark subtraction, HDR merge, light positions, scale, poses; or only reading, for imported
// sessions) and caches it under derived/calibrated/<key>. Fills *summary if there is one. Throws BadInput, Corrupt or
// Error.
CalibratedSession calibrate_session(const SessionStore& session, Progress& progress,
                                    CalibrationSummary* summary = nullptr, const CalibrationOptions& options = {});

}  // namespace lumitexel
