// Folders given on the command line. A wrong one is answered with what it is and what was expected: sessions and models are both folders,
// and are easily mistaken for each other.
#pragma once

#include <filesystem>
#include <string>

#include "processing/model/model.h"
#include "rig/session_store.h"

namespace lumitexel {

// "is a session", "is a model", "is an empty folder", "does not exist", "is a file", "is a folder that holds a.txt, b.txt, …".
std::string what_folder_is(const std::filesystem::path& path);

// `where`: the argument as the help has it, "MODEL" or "--session". Throws BadInput naming it and the folder.
Model model_given(const std::string& where, const std::filesystem::path& folder);
SessionStore session_given(const std::string& where, const std::filesystem::path& folder, OpenMode mode = OpenMode::ReadOnly);

}  // namespace lumitexel
