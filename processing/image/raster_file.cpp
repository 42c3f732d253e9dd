#include "processing/image/raster_file.h"

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "drivers/error.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

const char* const kExpectedRaster = "a whole PNG or TIFF of 8 or 16 bits with one or three channels";
constexpr std::string_view kPngSignature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::size_t kPngColourTypeOffset = 25;
constexpr char kPngGrayWithAlpha = 4;

bool is_png(std::string_view bytes) { return bytes.substr(0, 8) == kPngSignature; }

bool is_tiff(std::string_view bytes) {
  return bytes.substr(0, 4) == std::string_view("II*\0", 4) || bytes.substr(0, 4) == std::string_view("MM\0*", 4);
}

// Whether the chunks reach to IEND. Asked before decoding, because libpng prints to stderr when a file ends early.
bool png_is_whole(std::string_view bytes) {
  std::size_t at = kPngSignature.size();
  while (at + 12 <= bytes.size()) {
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    if (bytes.substr(at + 4, 4) == "IEND") return true;
    at += std::size_t{12} + length;
  }
  return false;
}

cv::Mat decode(const std::string& bytes) {
  try {
    return cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data())),
                        cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};
  }
}

template <typename Sample>
void copy_samples(const cv::Mat& from, Image& to) {
  const int channels = from.channels();
  for (int y = 0; y < to.height; ++y) {
    const Sample* row = from.ptr<Sample>(y);
    for (int x = 0; x < to.width; ++x) {
      for (int c = 0; c < to.channels; ++c) {  // OpenCV's order is B, G, R, alpha
        to.at(x, y, c) = static_cast<float>(row[x * channels + (to.channels == 3 ? 2 - c : 0)]);
      }
    }
  }
}

std::vector<std::uint8_t> png_bytes(const Image& image) {
  if (image.channels != 1 && image.channels != 3 && image.channels != 4) throw Error("a PNG has one, three or four channels");
  cv::Mat mat(image.height, image.width, CV_8UC(image.channels));
  for (int y = 0; y < image.height; ++y) {
    std::uint8_t* row = mat.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        const float value = image.at(x, y, image.channels >= 3 && c < 3 ? 2 - c : c);
        // Written so that NaN fails the first comparison and becomes 0.
        const float unit = value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f;
        row[x * image.channels + c] = static_cast<std::uint8_t>(unit * 255.0f + 0.5f);
      }
    }
  }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", mat, bytes)) throw Error("an image could not be encoded as PNG");
  return bytes;
}

}  // namespace

RasterImage read_raster(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path), where = path.string();
  const bool png = is_png(bytes);
  if (!png && !is_tiff(bytes)) throw BadInput(where, "neither PNG nor TIFF", kExpectedRaster);
  if (png && !png_is_whole(bytes)) throw BadInput(where, "the file ends early", kExpectedRaster);
  const cv::Mat mat = decode(bytes);
  if (mat.empty()) throw BadInput(where, "damaged or of an unsupported kind", kExpectedRaster);
  if (mat.depth() != CV_8U && mat.depth() != CV_16U) {
    throw BadInput(where, "samples that are neither 8 nor 16 bits", kExpectedRaster);
  }
  // OpenCV spreads gray with alpha over four channels.
  const bool gray = mat.channels() < 3 || (png && bytes[kPngColourTypeOffset] == kPngGrayWithAlpha);
  RasterImage image{Image(mat.cols, mat.rows, gray ? 1 : 3), mat.depth() == CV_8U ? 255.0f : 65535.0f};
  if (mat.depth() == CV_8U) {
    copy_samples<std::uint8_t>(mat, image.code_values);
  } else {
    copy_samples<std::uint16_t>(mat, image.code_values);
  }
  return image;
}

std::string encode_png8(const Image& unit_values) {
  const std::vector<std::uint8_t> bytes = png_bytes(unit_values);
  return {bytes.begin(), bytes.end()};
}

void write_png8(const std::filesystem::path& path, const Image& unit_values) {
  write_whole_file(path, encode_png8(unit_values));
}

}  // namespace lumitexel
