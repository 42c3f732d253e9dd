// Whether a session holds exactly what it says that it holds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rig/progress.h"
#include "rig/session_store.h"

namespace lumitexel {

struct SessionProblem {
  std::string file;  // relative to the session: "frames/000017_object.pgm", "session.db"
  std::string what;
};

struct SessionVerdict {
  std::int64_t frames = 0;  // in the journal
  std::vector<SessionProblem> problems;
  bool ok() const { return problems.empty(); }
};

// Reads everything. Every file's size and bytes against the journal's hash; of captured frames also the image header
// against the rig's camera, and role, settings and axis positions against the shot; shots without a frame; files in
// frames/ that are not in the journal; documents against their hashes; the database's own integrity check.
// Problems are returned, not thrown; throws only if the journal cannot be read at all (Corrupt, Error).
SessionVerdict verify_session(const SessionStore& session, Progress& progress);

}  // namespace lumitexel
