// Files that commands are told to write once long work is done: asked for before it begins.
#pragma once

#include <filesystem>
#include <string>

namespace lumitexel {

// Throws BadInput naming the option where the file's folder is none or cannot be written to. Nothing if `file` is empty.
void require_writable_folder(const std::string& option, const std::filesystem::path& file);

}  // namespace lumitexel
