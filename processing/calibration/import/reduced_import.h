// An imported session with fewer of its views.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <vector>

#include "rig/progress.h"
#include "rig/session_store.h"
#include "rig/view_selection.h"

namespace lumitexel {

// The images of images.txt, in its order. Throws Corrupt for a session that import_session did not write.
std::vector<SelectableView> imported_views(const SessionStore& session);

// A new session of the photographs and masks kept: images.txt, lights.csv and import.json lose the lines of the others,
// everything else is copied; with nothing left out it is byte for byte the same. It is made beside its place, then
// renamed. Returns how many frames were copied. Throws BadInput for a directory in use and for kinds of shots left out,
// which an imported session does not have; Corrupt for a frame that is not what was committed; Cancelled, StorageFull,
// Error.
std::int64_t copy_import(const SessionStore& session, const ViewSelection& selection,
                         const std::filesystem::path& directory, Progress& progress, std::stop_token stop = {});

}  // namespace lumitexel
