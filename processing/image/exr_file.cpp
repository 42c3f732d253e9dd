#include "processing/image/exr_file.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

#include "drivers/error.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

const char* const kExpectedExr = "an OpenEXR image of named planes, all at full resolution";
// Beyond any sensor; a header that claims more is damaged, and must not make us allocate what it claims.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 30;

std::int64_t extent(int low, int high) { return std::int64_t{high} - low + 1; }

void check_box(const std::string& where, const Imath::Box2i& box, const std::string& what) {
  const std::int64_t width = extent(box.min.x, box.max.x), height = extent(box.min.y, box.max.y);
  if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
    throw BadInput(where, what + " of " + std::to_string(width) + "x" + std::to_string(height), "1 to 2^30 pixels");
  }
}

Imf::PixelType to_imf(ExrPixel pixel) {
  return pixel == ExrPixel::Half ? Imf::HALF : pixel == ExrPixel::Uint ? Imf::UINT : Imf::FLOAT;
}

ExrPixel from_imf(Imf::PixelType type) {
  return type == Imf::HALF ? ExrPixel::Half : type == Imf::UINT ? ExrPixel::Uint : ExrPixel::Float;
}

// Copies the part of the data window that the display window shows; what the file has no data for is 0.
std::vector<float> cropped(const std::vector<float>& data, const Imath::Box2i& window, const Imath::Box2i& display) {
  const std::int64_t width = extent(display.min.x, display.max.x), data_width = extent(window.min.x, window.max.x);
  std::vector<float> result(static_cast<std::size_t>(width * extent(display.min.y, display.max.y)), 0.0f);
  const int x0 = std::max(window.min.x, display.min.x), x1 = std::min(window.max.x, display.max.x);
  for (int y = std::max(window.min.y, display.min.y); x0 <= x1 && y <= std::min(window.max.y, display.max.y); ++y) {
    const auto from = data.begin() + (std::int64_t{y} - window.min.y) * data_width + (std::int64_t{x0} - window.min.x);
    const auto to = (std::int64_t{y} - display.min.y) * width + (std::int64_t{x0} - display.min.x);
    std::copy(from, from + extent(x0, x1), result.begin() + to);
  }
  return result;
}

ExrImage read_planes(const std::string& where) {
  Imf::InputFile file(where.c_str());
  const Imath::Box2i display = file.header().displayWindow(), window = file.header().dataWindow();
  check_box(where, display, "a display window");
  check_box(where, window, "a data window");
  const std::int64_t width = extent(window.min.x, window.max.x), height = extent(window.min.y, window.max.y);

  ExrImage image;
  for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
    const Imf::Channel& channel = it.channel();
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      throw BadInput(where, std::string("channel ") + it.name() + " is subsampled", kExpectedExr);
    }
    image.planes.push_back(
        {it.name(), from_imf(channel.type), std::vector<float>(static_cast<std::size_t>(width * height))});
  }
  Imf::FrameBuffer buffer;
  for (ExrPlane& plane : image.planes) {
    buffer.insert(plane.name, Imf::Slice::Make(Imf::FLOAT, plane.data.data(), window));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);

  image.width = static_cast<int>(extent(display.min.x, display.max.x));
  image.height = static_cast<int>(extent(display.min.y, display.max.y));
  if (window != display) {
    for (ExrPlane& plane : image.planes) plane.data = cropped(plane.data, window, display);
  }
  return image;
}

std::uint32_t to_uint(float value) {
  if (!(value > 0.0f)) return 0;  // NaN as well
  const double rounded = std::round(static_cast<double>(value));
  return rounded >= 4294967295.0 ? std::numeric_limits<std::uint32_t>::max() : static_cast<std::uint32_t>(rounded);
}

// The plane's values in the type they are stored with; OpenEXR converts on reading but not on writing.
struct StoredPlane {
  std::vector<half> halves;
  std::vector<std::uint32_t> uints;
  const void* data = nullptr;
  std::size_t pixel_bytes = 4;

  explicit StoredPlane(const ExrPlane& plane) : data(plane.data.data()) {
    if (plane.stored == ExrPixel::Half) {
      halves.assign(plane.data.begin(), plane.data.end());
      data = halves.data();
      pixel_bytes = sizeof(half);
    } else if (plane.stored == ExrPixel::Uint) {
      std::transform(plane.data.begin(), plane.data.end(), std::back_inserter(uints), to_uint);
      data = uints.data();
    }
  }
};

std::string encode(const ExrImage& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 2;  // these files are computed again more often than they are sent anywhere
  std::vector<StoredPlane> stored;
  stored.reserve(image.planes.size());
  Imf::FrameBuffer buffer;
  for (const ExrPlane& plane : image.planes) {
    header.channels().insert(plane.name, Imf::Channel(to_imf(plane.stored)));
    const StoredPlane& values = stored.emplace_back(plane);
    buffer.insert(plane.name,
                  Imf::Slice::Make(to_imf(plane.stored), values.data, header.dataWindow(), values.pixel_bytes));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  }  // the line offsets are written on closing
  return stream.str();
}

const ExrPlane* find_plane(const ExrImage& image, const std::string& name) {
  const auto it =
      std::find_if(image.planes.begin(), image.planes.end(), [&](const ExrPlane& p) { return p.name == name; });
  return it == image.planes.end() ? nullptr : &*it;
}

}  // namespace

ExrImage read_exr(const std::filesystem::path& path) {
  const std::string where = path.string();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) throw BadInput(where, "no such file", kExpectedExr);
  try {
    return read_planes(where);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    // OpenEXR reports in several lines, some of which repeat the file's name.
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    throw BadInput(where, "damaged or not an OpenEXR file (" + what + ")", kExpectedExr);
  }
}

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  for (const ExrPlane& plane : image.planes) {
    if (plane.data.size() != pixels) throw Error(path.string() + ": plane " + plane.name + " has not the image's size");
  }
  std::string bytes;
  try {
    bytes = encode(image);
  } catch (const std::exception& error) {
    throw Error(path.string() + ": cannot be encoded as OpenEXR: " + error.what());
  }
  write_whole_file(path, bytes);
}

std::vector<std::string> colour_channel_names(int channels) {
  if (channels == 3) return {"R", "G", "B"};
  if (channels == 1) return {"Y"};
  throw Error("an image of " + std::to_string(channels) + " channels has no colour names; one or three have");
}

Image read_exr_colour(const std::filesystem::path& path) {
  const ExrImage planes = read_exr(path);
  const int channels = find_plane(planes, "R") != nullptr ? 3 : 1;
  Image image(planes.width, planes.height, channels);
  const std::vector<std::string> names = colour_channel_names(channels);
  for (std::size_t c = 0; c < names.size(); ++c) {
    const ExrPlane* plane = find_plane(planes, names[c]);
    if (plane == nullptr) throw BadInput(path.string(), "no channel " + names[c], "channels R, G and B, or Y");
    for (std::size_t i = 0; i < plane->data.size(); ++i) image.data[i * names.size() + c] = plane->data[i];
  }
  return image;
}

void write_exr_colour(const std::filesystem::path& path, const Image& image, ExrPixel stored) {
  const std::vector<std::string> names = colour_channel_names(image.channels);
  ExrImage planes{image.width, image.height, {}};
  for (std::size_t c = 0; c < names.size(); ++c) {
    ExrPlane plane{names[c], stored, std::vector<float>(image.data.size() / names.size())};
    for (std::size_t i = 0; i < plane.data.size(); ++i) plane.data[i] = image.data[i * names.size() + c];
    planes.planes.push_back(std::move(plane));
  }
  write_exr(path, planes);
}

}  // namespace lumitexel
