#include "processing/image/radiance_image.h"

#include <algorithm>
#include <string>

#include "drivers/error.h"
#include "processing/image/exr_file.h"

namespace lumitexel {
namespace {

constexpr const char* kVariancePrefix = "variance.";
constexpr const char* kFlagsPlane = "flags";

void append_planes(ExrImage& planes, const Image& image, const std::string& prefix) {
  const std::vector<std::string> names = colour_channel_names(image.channels);
  for (std::size_t c = 0; c < names.size(); ++c) {
    ExrPlane plane{prefix + names[c], ExrPixel::Float, std::vector<float>(image.data.size() / names.size())};
    for (std::size_t i = 0; i < plane.data.size(); ++i) plane.data[i] = image.data[i * names.size() + c];
    planes.planes.push_back(std::move(plane));
  }
}

const ExrPlane& plane_of(const ExrImage& planes, const std::string& name, const std::string& where) {
  for (const ExrPlane& plane : planes.planes) {
    if (plane.name == name) return plane;
  }
  throw Corrupt(where + ": no channel " + name + "; a calibrated photograph has one");
}

Image gathered(const ExrImage& planes, int channels, const std::string& prefix, const std::string& where) {
  Image image(planes.width, planes.height, channels);
  const std::vector<std::string> names = colour_channel_names(channels);
  for (std::size_t c = 0; c < names.size(); ++c) {
    const ExrPlane& plane = plane_of(planes, prefix + names[c], where);
    for (std::size_t i = 0; i < plane.data.size(); ++i) image.data[i * names.size() + c] = plane.data[i];
  }
  return image;
}

}  // namespace

void write_radiance_image(const std::filesystem::path& path, const RadianceImage& image) {
  ExrImage planes{image.radiance.width, image.radiance.height, {}};
  append_planes(planes, image.radiance, "");
  append_planes(planes, image.variance, kVariancePrefix);
  planes.planes.push_back({kFlagsPlane, ExrPixel::Uint, {image.flags.begin(), image.flags.end()}});
  write_exr(path, planes);
}

RadianceImage read_radiance_image(const std::filesystem::path& path) {
  ExrImage planes;
  try {
    planes = read_exr(path);
  } catch (const BadInput& error) {
    throw Corrupt(error.what());  // it is ours, so no input of the user's
  }
  const std::string where = path.string();
  const bool colour =
      std::any_of(planes.planes.begin(), planes.planes.end(), [](const ExrPlane& p) { return p.name == "R"; });
  RadianceImage image;
  image.radiance = gathered(planes, colour ? 3 : 1, "", where);
  image.variance = gathered(planes, colour ? 3 : 1, kVariancePrefix, where);
  const std::vector<float>& flags = plane_of(planes, kFlagsPlane, where).data;
  image.flags.reserve(flags.size());
  for (const float flag : flags) {
    if (!(flag >= 0.0f && flag <= 255.0f)) throw Corrupt(where + ": channel flags holds a value over 255");
    image.flags.push_back(static_cast<std::uint8_t>(flag));
  }
  return image;
}

}  // namespace lumitexel
