#include "processing/calibration/import/imported_photograph.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"

namespace lumitexel {
namespace {

std::string size_text(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

RadianceImage unflagged(Image radiance) {
  RadianceImage image;
  image.variance = Image(radiance.width, radiance.height, radiance.channels);
  image.flags.assign(static_cast<std::size_t>(radiance.width) * static_cast<std::size_t>(radiance.height), 0);
  image.radiance = std::move(radiance);
  return image;
}

RadianceImage through_response(const RasterImage& raster, const CodeResponse& response) {
  std::vector<float> radiance_of_code(static_cast<std::size_t>(raster.maximum) + 1);
  for (std::size_t code = 0; code < radiance_of_code.size(); ++code) {
    radiance_of_code[code] =
        static_cast<float>(response.radiance(static_cast<double>(code) / static_cast<double>(raster.maximum)));
  }
  RadianceImage image = unflagged(raster.code_values);
  const auto channels = static_cast<std::size_t>(raster.code_values.channels);
  for (std::size_t i = 0; i < image.radiance.data.size(); ++i) {
    const float code = raster.code_values.data[i];
    image.radiance.data[i] = radiance_of_code[static_cast<std::size_t>(code)];
    if (code >= raster.maximum) image.flags[i / channels] |= kPixelSaturated;
  }
  return image;
}

void check_values(const std::string& where, const Image& image) {
  const auto bad =
      std::find_if(image.data.begin(), image.data.end(), [](float value) { return !std::isfinite(value); });
  if (bad != image.data.end()) {
    const std::size_t pixel =
        static_cast<std::size_t>(bad - image.data.begin()) / static_cast<std::size_t>(image.channels);
    const std::size_t width = static_cast<std::size_t>(image.width);
    throw BadInput(where + ": pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")",
                   std::isnan(*bad) ? "NaN" : "an infinite value", "finite radiance");
  }
  if (std::none_of(image.data.begin(), image.data.end(), [](float value) { return value > 0.0f; })) {
    throw BadInput(where, "all pixels are black", "a photograph with some light in it");
  }
}

}  // namespace

bool is_exr_name(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".exr";
}

RadianceImage read_photograph(const std::filesystem::path& path, const CodeResponse& response) {
  if (is_exr_name(path)) {
    RadianceImage image = unflagged(read_exr_colour(path));
    check_values(path.string(), image.radiance);
    return image;
  }
  const RasterImage raster = read_raster(path);
  check_values(path.string(), raster.code_values);  // a curve may map black to more than 0
  return through_response(raster, response);
}

void apply_mask(const std::filesystem::path& mask, RadianceImage& photograph) {
  const RasterImage raster = read_raster(mask);
  const Image& values = raster.code_values;
  if (raster.maximum != 255.0f) throw BadInput(mask.string(), "a mask of 16 bits", "8 bits, 255 where the object is");
  if (values.width != photograph.radiance.width || values.height != photograph.radiance.height) {
    throw BadInput(mask.string(), "a mask of " + size_text(values),
                   "the photograph's " + size_text(photograph.radiance));
  }
  bool any_object = false;
  for (int y = 0; y < values.height; ++y) {
    for (int x = 0; x < values.width; ++x) {
      const auto first = values.data.begin() + static_cast<std::ptrdiff_t>(values.offset(x, y));
      const bool object = std::all_of(first, first + values.channels, [](float value) { return value == 255.0f; });
      any_object = any_object || object;
      if (!object) photograph.flags[values.offset(x, y) / static_cast<std::size_t>(values.channels)] |= kPixelOutside;
    }
  }
  if (!any_object) throw BadInput(mask.string(), "no pixel of the mask is 255", "255 where the object is");
}

}  // namespace lumitexel
