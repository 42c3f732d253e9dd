// Arrays of numbers inside a page.
//
// An array is written low bytes first, its bytes sorted into planes (all first bytes, all second bytes, …: smooth numbers deflate better
// so), deflated (zlib) and put into a <script type="text/plain"> as base64. A browser reads it with DecompressionStream("deflate").
// 16-bit arrays may be stored as differences to the number before (modulo 65536).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lumitexel {

enum class ChunkCoding { Plain, Differences };

class PackedChunks {
 public:
  void add(const std::string& name, const std::vector<std::uint8_t>& values);
  void add(const std::string& name, const std::vector<std::uint16_t>& values, ChunkCoding coding = ChunkCoding::Plain);
  void add(const std::string& name, const std::vector<float>& values);
  void add_text(const std::string& name, const std::string& text);  // bytes of UTF-8

  std::string markup() const;                          // the script elements
  std::string directory_json() const;                  // {"name": {"type": "u8" | "u16" | "f32", "count", "differences"}}
  std::map<std::string, std::size_t> bytes() const;    // in the page, by name
  std::size_t total_bytes() const;
  void append(PackedChunks&& others);

 private:
  struct Chunk {
    std::string name, type, base64;
    std::size_t count = 0;
    ChunkCoding coding = ChunkCoding::Plain;
  };
  template <typename Value>
  void store(const std::string& name, const char* type, const std::vector<Value>& values, ChunkCoding coding);

  std::vector<Chunk> chunks_;
};

// IEEE half precision, rounded to nearest; beyond its range: the largest half.
std::uint16_t half_bits(float value);

}  // namespace lumitexel
