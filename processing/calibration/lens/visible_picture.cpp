#include "processing/calibration/lens/visible_picture.h"

#include <algorithm>
#include <cmath>

#include "processing/image/demosaic.h"

namespace lumitexel {
namespace {

float quantile(std::vector<float> values, double fraction) {
  if (values.empty()) return 0.0f;
  const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// One value in so many is enough for a quantile.
std::vector<float> thinned(const std::vector<float>& values, std::size_t kept) {
  const std::size_t stride = std::max<std::size_t>(1, values.size() / kept) | 1u;  // odd: all columns of a mosaic
  std::vector<float> result;
  for (std::size_t i = 0; i < values.size(); i += stride) {
    if (std::isfinite(values[i])) result.push_back(values[i]);
  }
  return result;
}

}  // namespace

GrayPicture visible_picture(const MosaicRadiance& image) {
  GrayPicture picture{image.width, image.height, {}};
  picture.data.resize(image.value.size());
  const RadianceImage colours = demosaic(image);
  const int channel = colours.radiance.channels == 3 ? 1 : 0;
  const float brightest = quantile(thinned(image.value, 200'000), 0.999);
  const float dark_variance = quantile(thinned(image.variance, 200'000), 0.1);
  constexpr float kNoiseFloor_sigma = 16.0f, kLeastFloor = 1e-4f;
  const float floor = std::max(kNoiseFloor_sigma * std::sqrt(std::max(0.0f, dark_variance)), kLeastFloor * brightest);
  if (!(brightest > 0.0f) || !(floor > 0.0f)) return picture;  // a black frame shows nothing
  const float scale = 255.0f / std::asinh(brightest / floor);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float value = colours.radiance.at(x, y, channel);
      const float code = std::isfinite(value) ? scale * std::asinh(std::max(0.0f, value) / floor) : 255.0f;
      picture.data[image.index(x, y)] = static_cast<std::uint8_t>(std::lround(std::clamp(code, 0.0f, 255.0f)));
    }
  }
  return picture;
}

}  // namespace lumitexel
