#include "processing/calibration/light/ball_shading.h"

#include <array>
#include <cmath>

#include "processing/calibration/light/ball_shading_terms.h"

namespace lumitexel {

double BallShading::code(const Eigen::Vector3d& normal, const Eigen::Vector3d& light, double albedo,
                         double strength) const {
  const std::array<double, 5> p{gamma, ambient, roughness, gloss, gloss_width};
  return ball_code(p.data(), normal, light, albedo, strength);
}

}  // namespace lumitexel
