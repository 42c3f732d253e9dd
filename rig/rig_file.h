// A rig's file, which may build on another one.
#pragma once

#include <filesystem>
#include <string>

namespace lumitexel {

// The file's text. With `base = "OTHER.toml"` (relative to the file) at its top: the other file's tables with this
// one's keys laid over them, as one text without `base`; a base may have a base. A table with the key
// `replaces = true` takes the other's place whole. So a measured or a re-connected rig
// states only what differs. Files that a base names relative to itself are found all the same. Throws BadInput for a file that is missing, not TOML, or its own base.
std::string read_rig_file(const std::filesystem::path& file);

}  // namespace lumitexel
