// The two directions of a reflection, reduced to what an isotropic BRDF depends on, in a form that keeps its digits.
//
// A lobe of exponent N = 1e5 is a matter of 1 - cos(0.3 degrees): formed from rounded dot products, its value would lose as many
// digits as N has. So the gaps are made from differences of directions, in double, once per sample.
#pragma once

#include <Eigen/Core>

namespace lumitexel {

struct LobeGeometry {
  double cos_i = 0, cos_o = 0;  // n . wi, n . wo
  double mirror_gap = 1;        // |m(wi) - wo|^2 / 2 with m the mirror image about the normal: 1 - cos of the angle between; 0 … 2
  double retro_gap = 1;         // |wi - wo|^2 / 2: 1 - wi . wo
  double across2 = 0;           // squared length of the tangential part of wi + wo, which vanishes where the half vector is the normal

  double wi_dot_wo() const { return 1.0 - retro_gap; }
  double normal_product() const { return cos_i * cos_o; }
  double along() const { return cos_i + cos_o; }  // the normal part of wi + wo
};

// All three vectors unit.
LobeGeometry lobe_geometry(const Eigen::Vector3d& normal, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo);

// From rounded cosines: only for directions given by hand, where the digits near a gap of zero do not matter.
constexpr LobeGeometry geometry_of_cosines(double wi_dot_wo, double cos_i, double cos_o) {
  const double across2 = 2.0 + 2.0 * wi_dot_wo - (cos_i + cos_o) * (cos_i + cos_o);
  return {cos_i, cos_o, 1.0 - (2.0 * cos_i * cos_o - wi_dot_wo), 1.0 - wi_dot_wo, across2 > 0.0 ? across2 : 0.0};
}

// Of the half vector (wi + wo) / |wi + wo|: tan^2 of its angle to the normal (infinity for opposite directions), and its
// cosine with wi.
double half_tangent_squared(const LobeGeometry& geometry);
double cos_difference_angle(const LobeGeometry& geometry);

}  // namespace lumitexel
