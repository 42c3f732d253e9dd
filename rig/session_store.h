// A session on disk: what was wanted, what was measured, and nothing that is not so.
//
//   SESSION/session.db   SQLite (WAL, synchronous=FULL): documents, shots, frames, discarded attempts, events
//   SESSION/frames/      one immutable file per frame
//   SESSION/derived/     everything computed; may be deleted at any time
//
// A frame is written to a temporary name, synced, renamed, its folder synced, and only then committed to the
// journal. What is not in the journal did not happen: leftovers of an interrupted write are removed on opening
// for writing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rig/shot.h"

namespace lumitexel {

enum class SessionKind { Captured, Imported };
enum class OpenMode { ReadOnly, ReadWrite };

// A frame to be stored. shot_id is 0 for imported photographs and masks.
struct NewFrame {
  std::int64_t shot_id = 0;
  std::string name;           // file name inside frames/, e.g. "000017_object.pgm" or "fit_000.exr"; unique
  std::string role;           // to_string(ShotKind) for captured frames; "photograph" or "mask" for imported
  CameraSettings requested, applied, reported;
  std::int64_t utc_ns = 0;    // when the frame arrived
  double device_time_s = 0, sensor_temperature_c = 0;
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;  // as read back, not as asked
};

struct FrameRecord : NewFrame {
  std::int64_t id = 0;
  std::string sha256;  // lower-case hex of the file's bytes
  std::int64_t bytes = 0;
};

// An attempt at a shot that gave no frame to keep.
struct DiscardRecord {
  std::int64_t shot_id = 0;
  int attempt = 1;  // 1, 2, … of one call of Camera::shoot; begins anew when the shot is tried in a later run
  CameraSettings asked;
  std::optional<CameraSettings> reported;  // empty where no frame came
  std::string cause;
  std::int64_t utc_ns = 0;
};

// The session that another one is a replay of.
struct ReplaySource {
  std::string session;  // its folder, absolute
  std::string content_sha256;
  bool operator==(const ReplaySource&) const = default;
};

struct SessionEvent {
  std::int64_t utc_ns = 0;
  std::string level;  // "info", "warning", "error"
  std::string text;
};

class SessionStore {
 public:
  // Creates the directory and an empty journal. Throws BadInput if `directory` exists and is not an empty folder.
  static SessionStore create(const std::filesystem::path& directory, SessionKind kind);
  // Throws what create() would throw for this directory, and creates nothing.
  static void require_new_directory(const std::filesystem::path& directory);
  // ReadWrite: throws Error while another process has the session open for writing. ReadOnly never waits for it.
  // Throws BadInput if there is no session, Corrupt if the journal is not one of ours or of a newer version.
  static SessionStore open(const std::filesystem::path& directory, OpenMode mode);
  SessionStore(SessionStore&&) noexcept;
  SessionStore& operator=(SessionStore&&) noexcept;
  ~SessionStore();

  SessionKind kind() const;
  const std::filesystem::path& directory() const;
  std::filesystem::path frame_path(const FrameRecord& frame) const;
  std::filesystem::path derived_directory() const;  // created on demand

  // Whole input files, kept in the journal by name: "rig.toml", "plan.toml", "mesh.ply", "cameras.txt",
  // "lights.csv", … A document is written once; put_document throws Error if the name is taken.
  void put_document(const std::string& name, std::string_view bytes);
  bool has_document(const std::string& name) const;
  std::string document(const std::string& name) const;         // throws Corrupt if missing or its hash differs
  std::string document_sha256(const std::string& name) const;  // as recorded
  std::vector<std::string> document_names() const;             // sorted

  // All desired shots, once, in one transaction.
  void put_shots(const std::vector<Shot>& shots);
  std::vector<Shot> shots() const;          // in order of id
  std::vector<Shot> missing_shots() const;  // shots without a committed frame, in order of id

  // Commits one frame; when it returns, the frame survives a power cut.
  // Throws StorageFull, or Error if the shot already has a frame.
  FrameRecord commit_frame(const NewFrame& frame, std::string_view bytes);
  std::vector<FrameRecord> frames() const;  // in order of id

  void log_discard(const DiscardRecord& discard);
  std::vector<DiscardRecord> discards() const;  // in the order in which they happened

  // Not part of the content: a replay of everything has the content of its source.
  void put_replay_source(const ReplaySource& source);
  std::optional<ReplaySource> replay_source() const;

  void log_event(const std::string& level, const std::string& text, std::int64_t utc_ns);
  std::vector<SessionEvent> events() const;

  // What the database finds wrong with itself; empty if nothing.
  std::vector<std::string> journal_problems() const;

  // Hash over documents, shots and frame hashes: the identity of everything measured. A stage that reads this
  // session keys its cache with it.
  std::string content_sha256() const;

 private:
  struct Journal;
  explicit SessionStore(std::unique_ptr<Journal> journal);
  std::unique_ptr<Journal> journal_;
};

}  // namespace lumitexel
