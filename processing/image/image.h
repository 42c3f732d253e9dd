// A row-major image of linear floats with any number of channels, interleaved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lumitexel {

struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;  // (y * width + x) * channels + c

  Image() = default;
  Image(int w, int h, int c, float fill = 0.0f)
      : width(w), height(h), channels(c),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), fill) {}

  std::size_t offset(int x, int y, int c = 0) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels) + static_cast<std::size_t>(c);
  }
  float& at(int x, int y, int c = 0) { return data[offset(x, y, c)]; }
  float at(int x, int y, int c = 0) const { return data[offset(x, y, c)]; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

}  // namespace lumitexel
