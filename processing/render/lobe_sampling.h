// Directions drawn in proportion, about, to what one part of a BRDF reflects times the cosine: diffuse light, or one
// lobe of one shape. All vectors unit, in the surface's frame: z is the normal.
//
//   diffuse    cosine
//   Lafortune  cos^N about the axis C wo, which is the lobe itself: C = diag(-sin phi, -sin phi, cos phi)
//   GGX        normals that wo sees (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"), mirrored
//   Ward       the Gaussian of the half vector (Ward 1992; Walter 2005 for its density)
#pragma once

#include <Eigen/Core>

#include "processing/brdf/lobe_family.h"

namespace lumitexel {

class LobeSampler {
 public:
  LobeSampler() = default;  // diffuse
  LobeSampler(BrdfFamily family, double log_shape, double aim);

  // May lie below the surface, where nothing is reflected: then the sample counts and is zero.
  Eigen::Vector3d sample(const Eigen::Vector3d& wo, const Eigen::Vector2d& uniform) const;
  double density(const Eigen::Vector3d& wo, const Eigen::Vector3d& wi) const;  // 1/sr, of what sample() gives

 private:
  enum class Kind { Diffuse, Lafortune, Ggx, Ward };
  Kind kind_ = Kind::Diffuse;
  double shape_ = 1;                                   // N or alpha
  Eigen::Vector3d toward_ = Eigen::Vector3d::UnitZ();  // diagonal of C
};

}  // namespace lumitexel
