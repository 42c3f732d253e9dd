#include "rig/whole_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "drivers/error.h"

namespace lumitexel {

std::string read_whole_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw BadInput(path.string(), "no such file", "a readable file");
  if (!std::filesystem::is_regular_file(path, ignored)) throw BadInput(path.string(), "not a file", "a readable file");
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw BadInput(path.string(), std::string("cannot be read: ") + std::strerror(errno), "a readable file");
  return bytes;
}

void write_whole_file(const std::filesystem::path& path, std::string_view bytes) {
  std::filesystem::path temporary = path;
  temporary += ".partial";
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code failure;
  if (file) {
    std::filesystem::rename(temporary, path, failure);
    if (!failure) return;
  } else {
    failure = std::error_code(errno, std::generic_category());
  }
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw Error(path.string() + ": cannot be written: " + failure.message());
}

}  // namespace lumitexel
