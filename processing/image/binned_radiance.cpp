#include "processing/image/binned_radiance.h"

#include <stdexcept>

namespace lumitexel {
namespace {

Image mean_of_blocks(const Image& image, int block) {
  Image mean(image.width / block, image.height / block, image.channels);
  for (int y = 0; y < mean.height; ++y) {
    for (int x = 0; x < mean.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0.0;
        for (int v = 0; v < block; ++v) {
          for (int u = 0; u < block; ++u) sum += static_cast<double>(image.at(x * block + u, y * block + v, c));
        }
        mean.at(x, y, c) = static_cast<float>(sum / (block * block));
      }
    }
  }
  return mean;
}

std::uint8_t flag_of_block(const RadianceImage& image, int x, int y, int block) {
  std::uint8_t any = 0, all = 0xff;
  for (int v = 0; v < block; ++v) {
    for (int u = 0; u < block; ++u) {
      any |= image.flag(x * block + u, y * block + v);
      all &= image.flag(x * block + u, y * block + v);
    }
  }
  return static_cast<std::uint8_t>((any & kUnusablePixel) | (all & kPixelDark));
}

}  // namespace

RadianceImage binned(const RadianceImage& image, int block) {
  if (block < 1 || image.radiance.width < block || image.radiance.height < block) throw std::invalid_argument("binned: blocks larger than the image");
  RadianceImage result{mean_of_blocks(image.radiance, block), mean_of_blocks(image.variance, block), {}};
  for (float& variance : result.variance.data) variance /= static_cast<float>(block * block);
  result.flags.reserve(static_cast<std::size_t>(result.radiance.width) * static_cast<std::size_t>(result.radiance.height));
  for (int y = 0; y < result.radiance.height; ++y) {
    for (int x = 0; x < result.radiance.width; ++x) result.flags.push_back(flag_of_block(image, x, y, block));
  }
  return result;
}

}  // namespace lumitexel
