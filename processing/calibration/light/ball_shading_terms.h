// The formula of ball_shading.h for doubles and for Ceres' automatic derivatives alike.
#pragma once

#include <Eigen/Core>

namespace lumitexel {

// p: gamma, ambient, roughness, gloss, gloss width.
template <typename T>
T oren_nayar_factor(const T& roughness, const Eigen::Matrix<T, 3, 1>& n, const Eigen::Matrix<T, 3, 1>& l, const T& cos_i) {
  using std::sqrt;
  const T s2 = roughness * roughness;
  const T a = T(1.0) - T(0.5) * s2 / (s2 + T(0.33)), b = T(0.45) * s2 / (s2 + T(0.09));
  const T cos_o = n[2] > T(1e-3) ? n[2] : T(1e-3);
  // cos(phi) sin(alpha) tan(beta) without angles: the tangential parts of light and viewer, over the larger cosine.
  const T across = l[2] - cos_i * n[2];  // (l - cos_i n) . (z - cos_o n)
  if (!(across > T(0.0))) return a;
  return a + b * across / (cos_i > cos_o ? cos_i : cos_o);
}

template <typename T>
T ball_code(const T* p, const Eigen::Matrix<T, 3, 1>& n, const Eigen::Matrix<T, 3, 1>& l, const T& albedo,
            const T& strength) {
  using std::exp;
  using std::pow;
  const T cos_i = n.dot(l);
  T radiance = p[1];
  if (cos_i > T(0.0)) {
    radiance += strength * albedo * cos_i * oren_nayar_factor(p[2], n, l, cos_i);
    const Eigen::Matrix<T, 3, 1> h(l[0], l[1], l[2] + T(1.0));
    const T along = h.dot(n), square = h.squaredNorm() / (along * along);  // 1 / cos^2 = 1 + tan^2
    if (along > T(0.0)) radiance += strength * p[3] * exp((T(1.0) - square) / (p[4] * p[4]));
  }
  if (!(radiance > T(1e-6))) return T(0.0);  // the power's slope has no bound at zero
  return pow(radiance, T(1.0) / p[0]);
}

}  // namespace lumitexel
