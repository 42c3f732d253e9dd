#include "processing/brdf/numerics/scene_cases.h"

#include <quadmath.h>

#include <Eigen/Geometry>
#include <array>

#include "processing/brdf/numerics/lobe_trials.h"

namespace lumitexel {
namespace {

using QuadVector = std::array<Quad, 3>;

QuadVector difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {static_cast<Quad>(a[0]) - b[0], static_cast<Quad>(a[1]) - b[1], static_cast<Quad>(a[2]) - b[2]};
}

Quad dot(const QuadVector& a, const QuadVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

QuadVector unit(QuadVector v) {
  const Quad length = sqrtq(dot(v, v));
  for (Quad& x : v) x /= length;
  return v;
}

QuadGeometry exact(const QuadVector& n, const QuadVector& wi, const QuadVector& wo) {
  QuadGeometry g{dot(n, wi), dot(n, wo), 0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Quad across = (wi[k] - g.cos_i * n[k]) + (wo[k] - g.cos_o * n[k]), apart = wi[k] - wo[k];
    g.across2 += across * across;
    g.retro_gap += apart * apart / 2;
  }
  g.mirror_gap = (g.across2 + (g.cos_i - g.cos_o) * (g.cos_i - g.cos_o)) / 2;
  return g;
}

Eigen::Vector3d random_direction(RandomNumbers& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

double one_error(double size_m, RandomNumbers& random) {
  const LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {10.0, 1e4}, random);
  const Eigen::Vector3d normal = random_direction(random), point = 0.5 * size_m * normal;
  Eigen::Vector3d toward_light = random_direction(random);
  if (toward_light.dot(normal) < 0.0) toward_light = -toward_light;
  const Eigen::Vector3d mirrored = 2.0 * toward_light.dot(normal) * normal - toward_light;
  const Eigen::Vector3d toward_eye = mirrored + 2.0 / std::sqrt(std::exp(lobe.log_shape)) * random.uniform() * random_direction(random);
  const Eigen::Vector3d light = point + 1.5 * size_m * toward_light, eye = point + 1.5 * size_m * toward_eye;
  const LobeGeometry geometry = lobe_geometry(normal, (light - point).normalized(), (eye - point).normalized());
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return 0.0;
  const QuadVector n = unit({normal[0], normal[1], normal[2]});
  const QuadGeometry truth = exact(n, unit(difference(light, point)), unit(difference(eye, point)));
  const Quad wanted = reference_slopes(BrdfFamily::Lafortune, lobe.log_shape, kMirrorAim, truth).gain;
  const double found = lobe_family(BrdfFamily::Lafortune).terms(lobe.log_shape, kMirrorAim, geometry).gain;
  return static_cast<double>(wanted - static_cast<Quad>(found)) / std::max(1e-3, static_cast<double>(wanted));
}

}  // namespace

NumericCases scene_cases(std::size_t trials) {
  constexpr double kLimit = 2.5e-13;
  NumericCases cases;
  for (const auto& [size_m, text] : {std::pair(1e-3, "1 mm"), std::pair(1.0, "1 m"), std::pair(100.0, "100 m")}) {
    RandomNumbers random(31);
    LargestError error;
    for (std::size_t i = 0; i < trials; ++i) error.see(one_error(size_m, random));
    cases.push_back({std::string("object of ") + text, "value from positions, N 10 to 1e4", error.value(), kLimit});
  }
  return cases;
}

}  // namespace lumitexel
