// SHA-256 as lower-case hex.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lumitexel {

std::string sha256_hex(std::string_view bytes);
std::string sha256_hex_of_file(const std::filesystem::path& path);  // throws Error if it cannot be read

}  // namespace lumitexel
