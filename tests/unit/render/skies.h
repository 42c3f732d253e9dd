// Environments whose light has a closed form.
#pragma once

#include <string>
#include <vector>

#include "processing/render/environment.h"

namespace lumitexel {

inline Environment constant_sky(double red, double green, double blue) {
  Image image(8, 4, 3);
  for (std::size_t i = 0; i < image.data.size(); i += 3) {
    image.data[i] = static_cast<float>(red);
    image.data[i + 1] = static_cast<float>(green);
    image.data[i + 2] = static_cast<float>(blue);
  }
  return Environment(std::move(image), Eigen::Matrix3d::Identity(), "constant sky");
}

// Dark but for a few bright pixels among dim ones: what importance sampling is for. A function of the size alone.
inline Environment uneven_sky(int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int id = (x * 7 + y * 13) % 29;
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) = id == 0 ? 20.0f + 5.0f * static_cast<float>(c) : 0.05f * static_cast<float>(id % 4);
    }
  }
  return Environment(std::move(image), Eigen::Matrix3d::Identity(), "uneven sky");
}

}  // namespace lumitexel
