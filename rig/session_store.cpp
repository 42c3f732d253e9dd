#include "rig/session_store.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <set>

#include "drivers/error.h"
#include "rig/durable_file.h"
#include "rig/session_schema.h"
#include "rig/sha256.h"
#include "rig/sqlite_database.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJournalFile = "session.db";

constexpr const char* kShotColumns =
    "s.id, s.kind, s.view, s.place, s.exposure_s, s.gain_db, s.turntable_deg, s.light_azimuth_deg, "
    "s.light_elevation_deg";

constexpr const char* kFrameColumns =
    "id, shot_id, name, role, sha256, bytes, requested_exposure_s, requested_gain_db, applied_exposure_s, "
    "applied_gain_db, reported_exposure_s, reported_gain_db, utc_ns, device_time_s, sensor_temperature_c, "
    "turntable_deg, light_azimuth_deg, light_elevation_deg";

const char* to_string(SessionKind kind) { return kind == SessionKind::Captured ? "captured" : "imported"; }

SessionKind session_kind_from_string(const std::string& name, const std::string& file) {
  if (name == "captured") return SessionKind::Captured;
  if (name == "imported") return SessionKind::Imported;
  throw Corrupt(file + ": session kind '" + name + "' is not known");
}

// 17 digits: every double has a text of its own.
std::string exact(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

Shot shot_of(const SqliteStatement& row) {
  Shot shot;
  shot.id = row.integer(0);
  shot.kind = shot_kind_from_string(row.bytes(1));
  shot.view = row.bytes(2);
  shot.index = static_cast<int>(row.integer(3));
  shot.camera = {row.number(4), row.number(5)};
  shot.turntable_deg = row.number(6);
  shot.light_azimuth_deg = row.number(7);
  shot.light_elevation_deg = row.number(8);
  return shot;
}

FrameRecord frame_of(const SqliteStatement& row) {
  FrameRecord frame;
  frame.id = row.integer(0);
  frame.shot_id = row.integer(1);  // NULL reads as 0
  frame.name = row.bytes(2);
  frame.role = row.bytes(3);
  frame.sha256 = row.bytes(4);
  frame.bytes = row.integer(5);
  frame.requested = {row.number(6), row.number(7)};
  frame.applied = {row.number(8), row.number(9)};
  frame.reported = {row.number(10), row.number(11)};
  frame.utc_ns = row.integer(12);
  frame.device_time_s = row.number(13);
  frame.sensor_temperature_c = row.number(14);
  frame.turntable_deg = row.number(15);
  frame.light_azimuth_deg = row.number(16);
  frame.light_elevation_deg = row.number(17);
  return frame;
}

void require_file_name(const std::string& name) {
  // A leading dot is kept for unfinished files.
  if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos) {
    throw Error("frame name '" + name + "' is not a plain file name");
  }
}

}  // namespace

struct SessionStore::Journal {
  fs::path directory;
  std::optional<DirectoryLock> lock;  // of writers; released last
  SqliteDatabase database;
  SessionKind kind = SessionKind::Captured;

  Journal(const fs::path& folder, DatabaseMode mode)
      : directory(folder), lock(), database((take_lock(mode), folder / kJournalFile), mode) {}

  void take_lock(DatabaseMode mode) {
    if (mode != DatabaseMode::ReadOnly) lock.emplace(directory);
  }
  fs::path frames_directory() const { return directory / "frames"; }

  bool any(std::string_view sql, std::string_view text) {
    return database.prepare(sql).with(text).step();
  }

  std::vector<Shot> select_shots(const std::string& condition) {
    SqliteStatement rows =
        database.prepare("SELECT " + std::string(kShotColumns) + " FROM shots s " + condition + " ORDER BY s.id");
    std::vector<Shot> shots;
    while (rows.step()) shots.push_back(shot_of(rows));
    return shots;
  }

  void remove_unjournalled_files() {
    std::vector<fs::path> leftovers;
    for (const fs::directory_entry& entry : fs::directory_iterator(frames_directory())) {
      if (!entry.is_regular_file()) continue;
      if (!any("SELECT 1 FROM frames WHERE name = ?", entry.path().filename().string())) {
        leftovers.push_back(entry.path());
      }
    }
    for (const fs::path& path : leftovers) fs::remove(path);
    if (!leftovers.empty()) sync_directory(frames_directory());
  }

  void insert_frame(const FrameRecord& frame) {
    SqliteStatement insert = database.prepare("INSERT INTO frames (" + std::string(kFrameColumns) +
                                              ") VALUES (NULL,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
    frame.shot_id == 0 ? insert.with_null() : insert.with(frame.shot_id);
    insert.with(frame.name).with(frame.role).with(frame.sha256).with(frame.bytes);
    for (const CameraSettings& settings : {frame.requested, frame.applied, frame.reported}) {
      insert.with(settings.exposure_s).with(settings.gain_db);
    }
    insert.with(frame.utc_ns).with(frame.device_time_s).with(frame.sensor_temperature_c);
    insert.with(frame.turntable_deg).with(frame.light_azimuth_deg).with(frame.light_elevation_deg);
    insert.step();
  }
};

SessionStore::SessionStore(std::unique_ptr<Journal> journal) : journal_(std::move(journal)) {}
SessionStore::SessionStore(SessionStore&&) noexcept = default;
SessionStore& SessionStore::operator=(SessionStore&&) noexcept = default;
SessionStore::~SessionStore() = default;

SessionStore SessionStore::create(const fs::path& directory, SessionKind kind) {
  require_new_directory(directory);
  std::error_code failure;
  fs::create_directories(directory / "frames", failure);
  if (failure) throw Error(directory.string() + ": cannot be created: " + failure.message());
  auto journal = std::make_unique<Journal>(directory, DatabaseMode::Create);
  journal->kind = kind;
  create_session_schema(journal->database, to_string(kind));
  sync_directory(directory);
  sync_directory(fs::absolute(directory).lexically_normal().parent_path());
  return SessionStore(std::move(journal));
}

void SessionStore::require_new_directory(const fs::path& directory) {
  std::error_code ignored;  // a place that cannot even be looked at fails on creation, with the reason
  if (!fs::exists(directory, ignored)) return;
  if (!fs::is_directory(directory, ignored) || !fs::is_empty(directory, ignored)) {
    throw BadInput(directory.string(), "exists already", "a new session's folder: one that is empty or not there yet");
  }
}

SessionStore SessionStore::open(const fs::path& directory, OpenMode mode) {
  const fs::path file = directory / kJournalFile;
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw BadInput(directory.string(), "holds no session", std::string("a folder with a ") + kJournalFile);
  }
  const bool writing = mode == OpenMode::ReadWrite;
  auto journal = std::make_unique<Journal>(directory, writing ? DatabaseMode::ReadWrite : DatabaseMode::ReadOnly);
  check_session_schema(journal->database, file.string());
  SqliteStatement kind = journal->database.prepare("SELECT kind FROM session");
  journal->kind = session_kind_from_string(kind.step() ? kind.bytes(0) : "", file.string());
  if (writing) {
    upgrade_session_schema(journal->database);
    fs::create_directories(journal->frames_directory());
    journal->remove_unjournalled_files();
  }
  return SessionStore(std::move(journal));
}

SessionKind SessionStore::kind() const { return journal_->kind; }
const fs::path& SessionStore::directory() const { return journal_->directory; }
fs::path SessionStore::frame_path(const FrameRecord& frame) const { return journal_->frames_directory() / frame.name; }

fs::path SessionStore::derived_directory() const {
  const fs::path derived = journal_->directory / "derived";
  std::error_code failed;
  fs::create_directories(derived, failed);
  if (failed) throw Error(derived.string() + ": cannot be made (" + failed.message() + "); results are kept there");
  return derived;
}

void SessionStore::put_document(const std::string& name, std::string_view bytes) {
  journal_->database.prepare("INSERT INTO documents (name, sha256, bytes) VALUES (?, ?, ?)")
      .with(name).with(sha256_hex(bytes)).with_blob(bytes).step();
}

bool SessionStore::has_document(const std::string& name) const {
  return journal_->any("SELECT 1 FROM documents WHERE name = ?", name);
}

std::string SessionStore::document(const std::string& name) const {
  SqliteStatement row = journal_->database.prepare("SELECT bytes, sha256 FROM documents WHERE name = ?");
  const std::string place = (journal_->directory / kJournalFile).string() + ": document " + name;
  if (!row.with(name).step()) throw Corrupt(place + " is missing");
  std::string bytes = row.bytes(0);
  if (sha256_hex(bytes) != row.bytes(1)) throw Corrupt(place + " does not match its hash");
  return bytes;
}

std::string SessionStore::document_sha256(const std::string& name) const {
  SqliteStatement row = journal_->database.prepare("SELECT sha256 FROM documents WHERE name = ?");
  if (!row.with(name).step()) {
    throw Corrupt((journal_->directory / kJournalFile).string() + ": document " + name + " is missing");
  }
  return row.bytes(0);
}

std::vector<std::string> SessionStore::document_names() const {
  SqliteStatement rows = journal_->database.prepare("SELECT name FROM documents ORDER BY name");
  std::vector<std::string> names;
  while (rows.step()) names.push_back(rows.bytes(0));
  return names;
}

void SessionStore::put_shots(const std::vector<Shot>& shots) {
  SqliteTransaction transaction(journal_->database);
  if (journal_->database.prepare("SELECT 1 FROM shots").step()) {
    throw Error(journal_->directory.string() + ": the session has its shots already");
  }
  SqliteStatement insert = journal_->database.prepare("INSERT INTO shots VALUES (?,?,?,?,?,?,?,?,?)");
  for (const Shot& shot : shots) {
    insert.with(shot.id).with(lumitexel::to_string(shot.kind)).with(shot.view).with(std::int64_t{shot.index});
    insert.with(shot.camera.exposure_s).with(shot.camera.gain_db);
    insert.with(shot.turntable_deg).with(shot.light_azimuth_deg).with(shot.light_elevation_deg);
    insert.step();
    insert.reset();
  }
  transaction.commit();
}

std::vector<Shot> SessionStore::shots() const { return journal_->select_shots(""); }

std::vector<Shot> SessionStore::missing_shots() const {
  return journal_->select_shots("WHERE NOT EXISTS (SELECT 1 FROM frames f WHERE f.shot_id = s.id)");
}

FrameRecord SessionStore::commit_frame(const NewFrame& frame, std::string_view bytes) {
  require_file_name(frame.name);
  // Asked before the file is written: a frame that is in the journal is never touched again.
  if (journal_->any("SELECT 1 FROM frames WHERE name = ?", frame.name)) {
    throw Error(journal_->directory.string() + ": frame " + frame.name + " is committed already");
  }
  if (frame.shot_id != 0 &&
      journal_->database.prepare("SELECT 1 FROM frames WHERE shot_id = ?").with(frame.shot_id).step()) {
    throw Error(journal_->directory.string() + ": shot " + std::to_string(frame.shot_id) + " has its frame already");
  }
  FrameRecord record{frame, 0, sha256_hex(bytes), static_cast<std::int64_t>(bytes.size())};
  const fs::path file = frame_path(record);
  write_durably(file, bytes);
  // If this throws the file stays: a commit whose sync failed may yet be found in the journal after a crash. If it is not,
  // the next opening for writing removes the file.
  journal_->insert_frame(record);
  record.id = journal_->database.last_row_id();
  return record;
}

std::vector<FrameRecord> SessionStore::frames() const {
  SqliteStatement rows =
      journal_->database.prepare("SELECT " + std::string(kFrameColumns) + " FROM frames ORDER BY id");
  std::vector<FrameRecord> frames;
  while (rows.step()) frames.push_back(frame_of(rows));
  return frames;
}

void SessionStore::log_discard(const DiscardRecord& discard) {
  SqliteStatement insert = journal_->database.prepare("INSERT INTO discards VALUES (NULL,?,?,?,?,?,?,?,?)");
  insert.with(discard.shot_id).with(std::int64_t{discard.attempt});
  insert.with(discard.asked.exposure_s).with(discard.asked.gain_db);
  if (discard.reported) {
    insert.with(discard.reported->exposure_s).with(discard.reported->gain_db);
  } else {
    insert.with_null().with_null();
  }
  insert.with(discard.cause).with(discard.utc_ns).step();
}

std::vector<DiscardRecord> SessionStore::discards() const {
  std::vector<DiscardRecord> discards;
  if (!has_discard_tables(journal_->database)) return discards;
  SqliteStatement rows = journal_->database.prepare(
      "SELECT shot_id, attempt, asked_exposure_s, asked_gain_db, reported_exposure_s, reported_gain_db, cause, utc_ns "
      "FROM discards ORDER BY id");
  while (rows.step()) {
    DiscardRecord discard;
    discard.shot_id = rows.integer(0);
    discard.attempt = static_cast<int>(rows.integer(1));
    discard.asked = {rows.number(2), rows.number(3)};
    // A gain that is not a number is stored as NULL; the exposure alone would be half a truth.
    if (!rows.is_null(4) && !rows.is_null(5)) discard.reported = CameraSettings{rows.number(4), rows.number(5)};
    discard.cause = rows.bytes(6);
    discard.utc_ns = rows.integer(7);
    discards.push_back(std::move(discard));
  }
  return discards;
}

void SessionStore::put_replay_source(const ReplaySource& source) {
  journal_->database.prepare("INSERT INTO replayed_from VALUES (?, ?)")
      .with(source.session).with(source.content_sha256).step();
}

std::optional<ReplaySource> SessionStore::replay_source() const {
  if (!has_discard_tables(journal_->database)) return std::nullopt;
  SqliteStatement row = journal_->database.prepare("SELECT session, content_sha256 FROM replayed_from");
  if (!row.step()) return std::nullopt;
  return ReplaySource{row.bytes(0), row.bytes(1)};
}

void SessionStore::log_event(const std::string& level, const std::string& text, std::int64_t utc_ns) {
  journal_->database.prepare("INSERT INTO events (utc_ns, level, text) VALUES (?, ?, ?)")
      .with(utc_ns).with(level).with(text).step();
}

std::vector<SessionEvent> SessionStore::events() const {
  SqliteStatement rows = journal_->database.prepare("SELECT utc_ns, level, text FROM events ORDER BY id");
  std::vector<SessionEvent> events;
  while (rows.step()) events.push_back({rows.integer(0), rows.bytes(1), rows.bytes(2)});
  return events;
}

std::vector<std::string> SessionStore::journal_problems() const {
  std::vector<std::string> problems;
  for (const char* check : {"PRAGMA integrity_check", "PRAGMA foreign_key_check"}) {
    SqliteStatement rows = journal_->database.prepare(check);
    while (rows.step()) {
      if (rows.bytes(0) != "ok") problems.push_back(std::string(check).substr(7) + ": " + rows.bytes(0));
    }
  }
  return problems;
}

std::string SessionStore::content_sha256() const {
  std::string text = std::string(to_string(kind())) + "\n";
  for (const std::string& name : document_names()) text += "document " + name + " " + document_sha256(name) + "\n";
  for (const Shot& shot : shots()) {
    text += "shot " + std::to_string(shot.id) + " " + lumitexel::to_string(shot.kind) + " " + shot.view + " " +
            std::to_string(shot.index) + " " + exact(shot.camera.exposure_s) + " " + exact(shot.camera.gain_db) + "\n";
  }
  // By name, because a session that was interrupted commits the same frames in another order.
  std::vector<FrameRecord> all = frames();
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  for (const FrameRecord& frame : all) {
    text += "frame " + frame.name + " " + frame.role + " " + std::to_string(frame.shot_id) + " " + frame.sha256 + " " +
            exact(frame.turntable_deg) + " " + exact(frame.light_azimuth_deg) + " " +
            exact(frame.light_elevation_deg) + "\n";
  }
  return sha256_hex(text);
}

}  // namespace lumitexel
