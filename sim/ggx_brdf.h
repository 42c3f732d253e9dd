// Trowbridge-Reitz (GGX) microfacets with height-correlated Smith shadowing and Schlick's Fresnel term, over an
// optional diffuse base:
//
//   f = F(cos d) D G2 / (4 cos i cos o) + kd / pi (1 - F(cos i)) (1 - F(cos o))
//
// D and G2 as in Walter et al., EGSR 2007 (eq. 33) and Heitz, JCGT 2014 (eq. 99). f in 1/sr, reciprocal, reflects no
// more than it receives.
#pragma once

#include <Eigen/Core>

#include "processing/brdf/brdf.h"

namespace lumitexel {

struct GgxBrdf {
  double alpha = 0.1;                                   // roughness: the slope's scale
  Eigen::Array3d f0 = Eigen::Array3d::Constant(0.04);   // reflectance at normal incidence
  Eigen::Array3d diffuse = Eigen::Array3d::Zero();      // albedo kd of the base; 0 for metals
};

// f per channel. albedo_scale multiplies kd. 0 if either direction is not above the surface.
Eigen::Array3d evaluate(const GgxBrdf& brdf, const LobeGeometry& geometry, double albedo_scale = 1.0);

}  // namespace lumitexel
