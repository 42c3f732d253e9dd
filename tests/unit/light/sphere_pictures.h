// Sphere shots of the simulated bench as rendered pictures, and what calibration's light step makes of them.
#pragma once

#include <string>
#include <vector>

#include "processing/calibration/light/stray_lights.h"
#include "processing/calibration/session_lights.h"
#include "sim/simulated_world.h"

namespace lumitexel {

struct PicturedLights {
  SphereHighlights seen;
  SessionLights lights;                      // in the rig's frame
  std::vector<StrayLight> strays;
  std::vector<Eigen::Vector3d> true_in_rig;  // a view
  RigDescription rig;

  // Of a light that its spheres alone measured, in the camera's frame: (error^T covariance^-1 error), one for every degree of
  // freedom, and the error's length.
  double squared_sigmas(std::size_t view) const;
  double error_m(std::size_t view) const;
};

// The bench of config/rigs/simulated.toml with the dotted keys in `changes` (TOML, one a line) instead, as it really stands: where its
// arm is off, and nothing else; of the picture its upper 200 rows, where the spheres are. Photographs the spheres in so many views (at
// most 4: turntable a quarter on each, lights to
// all sides) and runs the light step on the frames. Throws what that throws.
// pixels: so many times more of them to every length.
PicturedLights photograph_spheres(const std::string& changes, int views = 2, int pixels = 1);

}  // namespace lumitexel
