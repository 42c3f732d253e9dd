#include "processing/report/viewer/viewer_sky.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/render/environment.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;

double height_of_row(int y, int rows) { return std::cos(kPi * y / rows) - std::cos(kPi * (y + 1) / rows); }

}  // namespace

Image built_in_sky() {
  constexpr int kWidth = 64, kHeight = 32;
  Image sky(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool key = x >= 26 && x < 38 && y >= 5 && y < 12, fill = x >= 8 && x < 13 && y >= 10 && y < 16;
      const float above = 1.0f - static_cast<float>(y) / (kHeight - 1);
      const float room[] = {0.10f + 0.15f * above, 0.10f + 0.17f * above, 0.10f + 0.20f * above};
      const float key_light[] = {9.0f, 9.2f, 9.6f}, fill_light[] = {7.0f, 5.6f, 4.2f};
      for (int c = 0; c < 3; ++c) sky.at(x, y, c) = key ? key_light[c] : fill ? fill_light[c] : room[c];
    }
  }
  return sky;
}

Image read_sky(const std::filesystem::path& path, int channels) {
  const Image sky = read_exr_colour(path);
  if (sky.channels != 1 && sky.channels != channels) {
    throw BadInput(path.string(), std::to_string(sky.channels) + " channels", channels == 1 ? "1, as the model has" : "1 or 3, as the model has");
  }
  Environment(sky, Eigen::Matrix3d::Identity(), path.string());  // refuses what is no environment
  return reduced_sky(sky, path.string());
}

Image reduced_sky(const Image& sky, const std::string& where) {
  const int block = (sky.width + kMostSkyWidth - 1) / kMostSkyWidth;
  if (sky.width % block != 0 || sky.height % block != 0) {
    throw BadInput(where, std::to_string(sky.width) + "x" + std::to_string(sky.height) + " pixels",
                   "a width and a height that blocks of " + std::to_string(block) + " pixels divide, to make it " + std::to_string(kMostSkyWidth) + " wide or less");
  }
  Image small(sky.width / block, sky.height / block, sky.channels);
  for (int y = 0; y < sky.height; ++y) {
    const double share = height_of_row(y, sky.height) / height_of_row(y / block, small.height) / block;
    for (int x = 0; x < sky.width; ++x) {
      for (int c = 0; c < sky.channels; ++c) small.at(x / block, y / block, c) += static_cast<float>(share * static_cast<double>(sky.at(x, y, c)));
    }
  }
  return small;
}

nlohmann::json viewer_sky_json(const Image& sky) { return {{"width", sky.width}, {"height", sky.height}}; }

void add_sky_chunk(const Image& sky, PackedChunks& chunks) {
  std::vector<float> values;
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x < sky.width; ++x) {
      for (int c = 0; c < 3; ++c) values.push_back(sky.at(x, y, std::min(c, sky.channels - 1)));
    }
  }
  chunks.add("sky", values);
}

}  // namespace lumitexel
