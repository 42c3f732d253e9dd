// Rough diffuse surface: the qualitative model of Oren and Nayar, SIGGRAPH 1994 (eq. 30):
//
//   f = rho / pi (A + B max(0, cos(phi_i - phi_o)) sin(a) tan(b)),   a = max(theta_i, theta_o), b = min(…)
//   A = 1 - 0.5 s^2 / (s^2 + 0.33),  B = 0.45 s^2 / (s^2 + 0.09)
//
// f in 1/sr, reciprocal; s is the standard deviation of the facets' slope angle.
#pragma once

#include <Eigen/Core>

#include "processing/brdf/brdf.h"

namespace lumitexel {

struct OrenNayarBrdf {
  Eigen::Array3d albedo = Eigen::Array3d::Constant(0.5);
  double sigma_rad = 0.3;
};

// f per channel. albedo_scale multiplies the albedo. 0 if either direction is not above the surface.
Eigen::Array3d evaluate(const OrenNayarBrdf& brdf, const LobeGeometry& geometry, double albedo_scale = 1.0);

}  // namespace lumitexel
