// The isotropic Lafortune model, written by its peak:
//
//   f(wi, wo) = kd + sum over lobes of A * max(0, D)^N,
//   D = (-sin(phi) * (wi_x wo_x + wi_y wo_y) + cos(phi) * wi_z wo_z) / max(|sin(phi)|, |cos(phi)|)
//
// in the local frame with z along the normal. In the paper's form (eq. 6 of section 6) Cx = Cy and Cz are
// Cx = -sin(phi) s, Cz = cos(phi) s with s = A^(1/N) / max(|sin|, |cos|); phi = pi/4 is the mirror direction. D <= 1 always, so A is
// the lobe's value at its peak and neither overflows nor vanishes for any N. f and A are in 1/sr, without the cosine.
//
// An isotropic lobe depends on the directions only through c = wi . wo and p = (n . wi)(n . wo); no tangent frame is needed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace lumitexel {

inline constexpr int kMaxChannels = 3;

struct LafortuneLobe {
  double log_peak = 0;      // ln A; -infinity switches the lobe off
  double phi = 0.7853981633974483;
  double log_exponent = 2;  // ln N, N in [1e-2, 1e5]
};

struct LafortuneBrdf {
  int channels = 3;
  std::array<double, kMaxChannels> diffuse{};                     // kd per channel, 1/sr, >= 0
  std::vector<std::array<LafortuneLobe, kMaxChannels>> lobes;     // each with one entry per channel
};

// What an isotropic BRDF needs to know of two directions and a normal.
struct LobeGeometry {
  double wi_dot_wo = 0, cos_i = 0, cos_o = 0;
};
LobeGeometry lobe_geometry(const Eigen::Vector3d& normal, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo);

// f in channel c, 1/sr; 0 if either direction is below the surface.
double evaluate(const LafortuneBrdf& brdf, int c, const LobeGeometry& geometry);

}  // namespace lumitexel
