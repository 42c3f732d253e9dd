// What calibration measured beside what the fit needs: uncertainties and figures that tell whether to trust it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace lumitexel {

struct LightSummary {
  std::string view;
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();  // for directional lights the unit vector towards it
  double sigma_m = 0;                                           // per axis; 0 if unknown
  bool from_spheres = false;                                    // false: predicted by the arm alone, or imported
  int highlights = 0, outliers = 0;
  double residual_px = 0;
  Eigen::Vector3d spheres_alone_in_world = Eigen::Vector3d::Zero();  // the spheres' measurement without the arm's help
  double spheres_alone_sigma_m = 0;
  bool off_the_arm = false;  // farther from the aligned arm than 5 sigma
};

struct CalibrationSummary {
  std::vector<LightSummary> lights;  // in the order of the session's views
  double sphere_residual_px = 0;     // rms over all highlights of the session
  double sphere_sigma_scale = 0;     // residuals over stated sigmas
  double arm_scatter_m = 0, arm_residual_m = 0;
  std::vector<double> intensity, gray_card_pixel_scatter;
  double scale_sigma = 0;            // relative
  std::int64_t hot_pixels = 0;       // in the darks with the most of them
  int views_without_silhouette = 0;  // masked by the mesh's projection alone
};

}  // namespace lumitexel
