// Files and folders that commands are told to write once long work is done: asked for before it begins.
#pragma once

#include <filesystem>
#include <string>

#include "rig/pending_directory.h"

namespace lumitexel {

// Throws BadInput naming the option where the file's folder is none or cannot be written to. Nothing if `file` is empty.
void require_writable_folder(const std::string& option, const std::filesystem::path& file);

// The folder to write into until it is moved to `folder`. Throws BadInput naming the option where it cannot be made.
PendingDirectory pending_output(const std::string& option, const std::filesystem::path& folder);

}  // namespace lumitexel
