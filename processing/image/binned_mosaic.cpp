#include "processing/image/binned_mosaic.h"

#include <stdexcept>

namespace lumitexel {
namespace {

constexpr int kGreen = 1;

}  // namespace

MosaicRadiance binned(MosaicRadiance image, int block) {
  if (block == 1) return image;
  const bool odd = block % 2 != 0 && image.mosaic != Mosaic::Mono;
  if (block < 1 || odd || image.width < block || image.height < block) throw std::invalid_argument("binned: no such blocks in this mosaic");
  MosaicRadiance result;
  result.darks_drifted = image.darks_drifted;
  result.dark_scale = image.dark_scale;
  result.width = image.width / block;
  result.height = image.height / block;
  const std::size_t pixels = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height);
  result.value.assign(pixels, 0.0f);
  result.variance.assign(pixels, 0.0f);
  result.flags.assign(pixels, 0);
  const bool colours = image.mosaic != Mosaic::Mono;
  const double count = colours ? block * block / 2 : block * block;
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      double value = 0.0, variance = 0.0;
      std::uint8_t flags = 0;
      for (int v = 0; v < block; ++v) {
        for (int u = 0; u < block; ++u) {
          if (colours && mosaic_channel(image.mosaic, x * block + u, y * block + v) != kGreen) continue;
          const std::size_t i = image.index(x * block + u, y * block + v);
          value += static_cast<double>(image.value[i]);
          variance += static_cast<double>(image.variance[i]);
          flags |= image.flags[i];
        }
      }
      const std::size_t to = result.index(x, y);
      result.value[to] = static_cast<float>(value / count);
      result.variance[to] = static_cast<float>(variance / (count * count));
      result.flags[to] = flags;
    }
  }
  return result;
}

}  // namespace lumitexel
