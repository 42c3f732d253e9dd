#include "processing/image/tone_map.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

float srgb_encoded(float linear) {
  if (!(linear > 0.0f)) return 0.0f;  // NaN as well
  if (linear >= 1.0f) return 1.0f;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Image tone_mapped(const Image& radiance, double white) {
  Image shown(radiance.width, radiance.height, 3);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float linear = radiance.at(x, y, std::min(c, radiance.channels - 1));
        shown.at(x, y, c) = srgb_encoded(static_cast<float>(linear / white));
      }
    }
  }
  return shown;
}

}  // namespace lumitexel
