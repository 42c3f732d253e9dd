#include "drivers/aravis/received_frame.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <span>

#include "drivers/error.h"

namespace lumitexel {
namespace {

void require_image(ArvBuffer* buffer, const CameraLimits& limits, const std::string& camera) {
  const ArvBufferPayloadType type = arv_buffer_get_payload_type(buffer);
  if (type != ARV_BUFFER_PAYLOAD_TYPE_IMAGE && type != ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA) {
    throw Protocol(camera + ": asked for an image, the frame's payload is of type " + std::to_string(type));
  }
  const int width = arv_buffer_get_image_width(buffer), height = arv_buffer_get_image_height(buffer);
  if (width != limits.width_px || height != limits.height_px) {
    throw Protocol(camera + ": asked for " + std::to_string(limits.width_px) + " x " + std::to_string(limits.height_px) +
                   " pixels, the frame has " + std::to_string(width) + " x " + std::to_string(height));
  }
}

std::vector<std::uint16_t> samples_of(ArvBuffer* buffer, const CameraSetup& setup, const CameraLimits& limits,
                                      const std::string& camera) {
  const std::size_t pixels = static_cast<std::size_t>(limits.width_px) * static_cast<std::size_t>(limits.height_px);
  std::size_t size = 0;
  // The size includes the chunks.
  const auto* data = static_cast<const std::uint8_t*>(arv_buffer_get_image_data(buffer, &size));
  if (data == nullptr || size < setup.layout.bytes(pixels)) {
    throw Protocol(camera + ": asked for " + std::to_string(setup.layout.bytes(pixels)) + " bytes of image, the frame has " +
                   std::to_string(size));
  }
  std::vector<std::uint16_t> samples = decoded(setup.layout, std::span(data, size), pixels);
  const unsigned most = (1u << limits.bits) - 1u;
  // All bits that any sample has: found much sooner than the largest.
  const unsigned used = std::accumulate(samples.begin(), samples.end(), 0u, std::bit_or<unsigned>());
  if (used > most) {
    throw Protocol(camera + ": bits = " + std::to_string(limits.bits) + " in the rig's description, the frame has samples beyond, up to " +
                   std::to_string(*std::max_element(samples.begin(), samples.end())) + "; the camera may shift its samples up");
  }
  return samples;
}

double real_chunk(ArvChunkParser* chunks, ArvBuffer* buffer, const char* name, const std::string& camera) {
  GErrorSlot error;
  const double value = arv_chunk_parser_get_float_value(chunks, buffer, name, error);
  if (error.is_set() || !std::isfinite(value)) throw Protocol(camera + ": asked for the frame's " + name + ", it has none");
  return value;
}

std::uint64_t integer_chunk(ArvChunkParser* chunks, ArvBuffer* buffer, const std::string& name,
                            const std::string& camera) {
  GErrorSlot error;
  const gint64 value = arv_chunk_parser_get_integer_value(chunks, buffer, name.c_str(), error);
  if (error.is_set()) throw Protocol(camera + ": asked for the frame's " + name + ", it has none");
  return static_cast<std::uint64_t>(value);
}

void read_chunks(Frame& frame, ArvBuffer* buffer, ArvChunkParser* chunks, const CameraSetup& setup,
                 const std::string& frame_name_chunk, const std::string& camera) {
  if (!setup.any_chunk()) return;
  if (!arv_buffer_has_chunks(buffer)) throw Protocol(camera + ": asked for chunks, the frame has none");
  if (setup.exposure_chunk) frame.reported.exposure_s = 1e-6 * real_chunk(chunks, buffer, "ChunkExposureTime", camera);
  if (setup.gain_chunk) frame.reported.gain_db = real_chunk(chunks, buffer, "ChunkGain", camera);
  if (setup.name_chunk) frame.echoed_key = integer_chunk(chunks, buffer, frame_name_chunk, camera);
}

}  // namespace

Frame received_frame(ArvBuffer* buffer, ArvChunkParser* chunks, const CameraSetup& setup, const CameraLimits& limits,
                     const std::string& frame_name_chunk, const std::string& camera) {
  require_image(buffer, limits, camera);
  Frame frame;
  frame.width_px = limits.width_px;
  frame.height_px = limits.height_px;
  frame.bits = limits.bits;
  frame.mosaic = limits.mosaic;
  frame.samples = samples_of(buffer, setup, limits, camera);
  frame.reported = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  frame.device_time_s = 1e-9 * static_cast<double>(arv_buffer_get_timestamp(buffer));
  frame.device_frame_id = arv_buffer_get_frame_id(buffer);
  read_chunks(frame, buffer, chunks, setup, frame_name_chunk, camera);
  return frame;
}

}  // namespace lumitexel
