// Photometric stereo with a known shading: a pixel's normal and albedo from its codes under known distant lights.
//
// A linear Lambert solution over the lit pictures starts a non-linear fit of the whole shading model with a heavy-tailed
// loss, which deals with attached shadows (the model has them) and with cast ones and dust (the loss has them).
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/light/directional_lights.h"

namespace lumitexel {

struct ShadedNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double albedo = 0;
  double sigma_rad = 0;  // per axis, from the residuals: scaled to sigma_code or to their own rms, whichever is larger
};

// None if fewer than three pictures are unclipped or the fit ends facing away from the viewer.
std::optional<ShadedNormal> normal_from_shading(const DirectionalLights& lights, const std::vector<double>& code,
                                                double sigma_code);

}  // namespace lumitexel
