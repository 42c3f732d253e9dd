// A patch of a surface with known normals under known lights: the mesh is a plane, the surface a sum of waves on it.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/normals/directed_samples.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

struct PatchSettings {
  int side = 40;             // texels
  int views = 12;            // at least 5 of them
  double slope_rms_rad = 0.07;  // of the true normals from the mesh's, per axis
  double noise = 0.03;       // relative, of every sample
  unsigned seed = 1;
  double ridge_rad = 0.0;    // two planes that fall away on both sides of the middle, this steep
};

struct NormalPatch {
  CalibratedSession session;
  LumitexelSet lumitexels;  // normals of the mesh
  std::vector<Eigen::Vector3d> truth;
  int width = 0;            // of the atlas
  std::vector<std::vector<Brdf>> bases;
  std::vector<int> label;
  double median_reflectance = 0;
};

// Diffuse with a lobe of exponent 30; one material.
NormalPatch make_patch(const PatchSettings& settings);

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
double rms_angle(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);
std::vector<Eigen::Vector3d> mesh_normals(const NormalPatch& patch);

}  // namespace lumitexel
