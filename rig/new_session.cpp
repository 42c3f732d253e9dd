#include "rig/new_session.h"

#include "drivers/error.h"
#include "rig/durable_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

void fill(const fs::path& directory, const SessionContent& content) {
  SessionStore store = SessionStore::create(directory, SessionKind::Captured);
  for (const auto& [name, bytes] : content.documents) store.put_document(name, bytes);
  store.put_shots(content.shots);
  if (content.replayed_from) store.put_replay_source(*content.replayed_from);
  if (content.add_files) content.add_files(directory);
}

}  // namespace

SessionStore begin_session(const fs::path& directory, const SessionContent& content) {
  SessionStore::require_new_directory(directory);
  // "out/" and "out" are the same folder; only the latter has a name to add to.
  fs::path target = fs::absolute(directory).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();
  const fs::path preparing = target.string() + ".preparing";
  fs::remove_all(preparing);
  try {
    fill(preparing, content);
    fs::rename(preparing, target);
    sync_directory(target.parent_path());
  } catch (const std::exception&) {
    std::error_code ignored;
    fs::remove_all(preparing, ignored);
    throw;
  }
  return SessionStore::open(directory, OpenMode::ReadWrite);
}

}  // namespace lumitexel
