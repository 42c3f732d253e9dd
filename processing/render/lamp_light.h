// What lamps, point or directional, bring to a surface point and its BRDF sends on, with shadows.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model_surface.h"
#include "processing/render/texel_brdf.h"

namespace lumitexel {

// The radiance towards the viewer for whom `texel` was set. 0 from lamps below the triangle or behind something.
ChannelValues light_of_lamps(const ModelSurface& surface, const TexturedPoint& point, const TexelReflection& texel,
                             const std::vector<Light>& lamps);

// Throws BadInput naming the view for a lamp with another number of channels.
void check_lamps(const View& view, const std::vector<Light>& lamps, int channels);

}  // namespace lumitexel
