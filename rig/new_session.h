// A captured session comes into being complete, with its documents and shots, or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rig/session_store.h"
#include "rig/shot.h"

namespace lumitexel {

struct SessionContent {
  std::map<std::string, std::string> documents;  // by name
  std::vector<Shot> shots;
  // Puts further files into the session's folder before anybody sees it; may be empty.
  std::function<void(const std::filesystem::path&)> add_files;
  std::optional<ReplaySource> replayed_from = std::nullopt;
};

// Everything is made in a folder beside, DIRECTORY.preparing, which is then renamed; a kill at any moment leaves either
// nothing under `directory` or a session to resume. Leftovers of an earlier attempt are removed.
// Throws BadInput if `directory` exists and is not an empty folder, StorageFull or Error.
SessionStore begin_session(const std::filesystem::path& directory, const SessionContent& content);

}  // namespace lumitexel
