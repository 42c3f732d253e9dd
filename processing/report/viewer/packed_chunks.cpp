#include "processing/report/viewer/packed_chunks.h"

#include <zlib.h>

#include <ImathConfig.h>
#include <algorithm>
#include <bit>
#include <cstring>
#include <half.h>
#include <iterator>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/report/base64.h"

namespace lumitexel {
namespace {

static_assert(std::endian::native == std::endian::little, "chunks are written low bytes first");

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
  if (status != Z_OK) throw Error("viewer: zlib could not deflate " + std::to_string(bytes.size()) + " bytes");
  packed.resize(size);
  return packed;
}

}  // namespace

template <typename Value>
void PackedChunks::store(const std::string& name, const char* type, const std::vector<Value>& values, ChunkCoding coding) {
  std::string planes(values.size() * sizeof(Value), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    char bytes[sizeof(Value)];
    std::memcpy(bytes, &values[i], sizeof(Value));
    for (std::size_t b = 0; b < sizeof(Value); ++b) planes[b * values.size() + i] = bytes[b];
  }
  chunks_.push_back({name, type, base64(deflated(planes)), values.size(), coding});
}

void PackedChunks::add(const std::string& name, const std::vector<std::uint8_t>& values) {
  store(name, "u8", values, ChunkCoding::Plain);
}

void PackedChunks::add(const std::string& name, const std::vector<std::uint16_t>& values, ChunkCoding coding) {
  if (coding == ChunkCoding::Plain) return store(name, "u16", values, coding);
  std::vector<std::uint16_t> differences(values.size());
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    differences[i] = static_cast<std::uint16_t>(values[i] - before);
    before = values[i];
  }
  store(name, "u16", differences, coding);
}

void PackedChunks::add(const std::string& name, const std::vector<float>& values) {
  store(name, "f32", values, ChunkCoding::Plain);
}

void PackedChunks::add_text(const std::string& name, const std::string& text) {
  add(name, std::vector<std::uint8_t>(text.begin(), text.end()));
}

std::string PackedChunks::markup() const {
  std::string text;
  for (const Chunk& chunk : chunks_) {
    text += "<script type=\"text/plain\" id=\"chunk-" + chunk.name + "\">" + chunk.base64 + "</script>\n";
  }
  return text;
}

std::string PackedChunks::directory_json() const {
  nlohmann::json directory = nlohmann::json::object();
  for (const Chunk& chunk : chunks_) {
    directory[chunk.name] = {
        {"type", chunk.type}, {"count", chunk.count}, {"differences", chunk.coding == ChunkCoding::Differences}};
  }
  return directory.dump();
}

std::map<std::string, std::size_t> PackedChunks::bytes() const {
  std::map<std::string, std::size_t> sizes;
  for (const Chunk& chunk : chunks_) sizes[chunk.name] = chunk.base64.size();
  return sizes;
}

std::size_t PackedChunks::total_bytes() const {
  std::size_t sum = 0;
  for (const Chunk& chunk : chunks_) sum += chunk.base64.size();
  return sum;
}

void PackedChunks::append(PackedChunks&& others) {
  chunks_.insert(chunks_.end(), std::make_move_iterator(others.chunks_.begin()), std::make_move_iterator(others.chunks_.end()));
}

std::uint16_t half_bits(float value) { return half(std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX))).bits(); }

}  // namespace lumitexel
