// How a frame's key is written into a picture's EXIF artist or copyright, and read from it: "lumitexel-42".
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lumitexel {

inline constexpr std::string_view kFrameNamePrefix = "lumitexel-";

inline std::string frame_name(std::uint64_t frame_key) {
  return std::string(kFrameNamePrefix) + std::to_string(frame_key);
}

// Empty if the text is not one of frame_name()'s; blanks behind it, which some cameras add, do not matter.
inline std::optional<std::uint64_t> frame_key_of(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
  if (!text.starts_with(kFrameNamePrefix)) return {};
  text.remove_prefix(kFrameNamePrefix.size());
  std::uint64_t key = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), key);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return key;
}

}  // namespace lumitexel
