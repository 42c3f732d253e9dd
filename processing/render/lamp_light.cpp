#include "processing/render/lamp_light.h"

#include <string>

#include "drivers/error.h"

namespace lumitexel {

ChannelValues light_of_lamps(const ModelSurface& surface, const TexturedPoint& point, const TexelReflection& texel,
                             const std::vector<Light>& lamps) {
  ChannelValues radiance{};
  for (const Light& lamp : lamps) {
    const Eigen::Vector3d wi = lamp.direction_from(point.position_in_world);
    if (!(point.geometric_normal.dot(wi) > 0.0)) continue;
    const ChannelValues r = texel.reflectance(wi);
    if (r == ChannelValues{} || !surface.sees(point, lamp)) continue;
    for (std::size_t c = 0; c < lamp.intensity.size(); ++c) {
      radiance[c] += r[c] * lamp.irradiance(point.position_in_world, static_cast<int>(c));
    }
  }
  return radiance;
}

void check_lamps(const View& view, const std::vector<Light>& lamps, int channels) {
  for (const Light& lamp : lamps) {
    if (lamp.intensity.size() == static_cast<std::size_t>(channels)) continue;
    throw BadInput(view.name + ": light", std::to_string(lamp.intensity.size()) + " channels",
                   std::to_string(channels) + " as the model has");
  }
}

}  // namespace lumitexel
