#include "rig/session_store.h"

#include <gtest/gtest.h>

#include <optional>

#include <fstream>

#include "drivers/error.h"
#include "rig/durable_file.h"
#include "rig/new_session.h"
#include "rig/sha256.h"
#include "rig/sqlite_database.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

std::vector<Shot> two_shots() {
  return {{1, ShotKind::Object, "fit_000", 3, {0.1 + 0.2, 6.0}, 12.5, -3.25, 40.0},
          {2, ShotKind::Dark, "", 0, {1.0 / 3.0, 6.0}, 12.5, -3.25, 40.0}};
}

NewFrame frame_for(const Shot& shot) {
  NewFrame frame;
  frame.shot_id = shot.id;
  frame.name = frame_file_name(shot);
  frame.role = to_string(shot.kind);
  frame.requested = shot.camera;
  frame.applied = {0.125, 1.0};
  frame.reported = {0.25, 2.0};
  frame.utc_ns = 1'700'000'000'123'456'789;
  frame.device_time_s = 1e-7;
  frame.sensor_temperature_c = -3.5;
  frame.turntable_deg = 12.500001;
  frame.light_azimuth_deg = -3.25;
  frame.light_elevation_deg = 40.1;
  return frame;
}

TEST(SessionStore, EverythingComesBackAfterReopening) {
  const TemporaryFolder folder;
  const std::string bytes("P5\0\xff\n", 5);
  {
    SessionStore store = SessionStore::create(folder / "s", SessionKind::Captured);
    store.put_document("rig.toml", std::string("a\0b", 3));
    store.put_document("empty", "");
    store.put_shots(two_shots());
    const FrameRecord record = store.commit_frame(frame_for(two_shots()[1]), bytes);
    EXPECT_EQ(record.sha256, sha256_hex(bytes));
    store.log_event("info", "hello", 42);
  }
  const SessionStore store = SessionStore::open(folder / "s", OpenMode::ReadOnly);
  EXPECT_EQ(store.kind(), SessionKind::Captured);
  EXPECT_EQ(store.document("rig.toml"), std::string("a\0b", 3));
  EXPECT_EQ(store.document("empty"), "");
  EXPECT_EQ(store.document_names(), (std::vector<std::string>{"empty", "rig.toml"}));
  EXPECT_TRUE(store.has_document("empty"));
  EXPECT_FALSE(store.has_document("none"));
  EXPECT_THROW(store.document("none"), Corrupt);

  const std::vector<Shot> shots = store.shots();
  ASSERT_EQ(shots.size(), 2u);
  EXPECT_EQ(shots[0].kind, ShotKind::Object);
  EXPECT_EQ(shots[0].view, "fit_000");
  EXPECT_EQ(shots[0].index, 3);
  EXPECT_EQ(shots[0].camera, two_shots()[0].camera);  // to the last bit
  EXPECT_EQ(shots[1].light_azimuth_deg, -3.25);
  ASSERT_EQ(store.missing_shots().size(), 1u);
  EXPECT_EQ(store.missing_shots()[0].id, 1);

  const std::vector<FrameRecord> frames = store.frames();
  ASSERT_EQ(frames.size(), 1u);
  const NewFrame expected = frame_for(two_shots()[1]);
  EXPECT_EQ(frames[0].shot_id, 2);
  EXPECT_EQ(frames[0].name, "000002_dark.pgm");
  EXPECT_EQ(frames[0].role, "dark");
  EXPECT_EQ(frames[0].bytes, 5);
  EXPECT_EQ(frames[0].requested, expected.requested);
  EXPECT_EQ(frames[0].applied, expected.applied);
  EXPECT_EQ(frames[0].reported, expected.reported);
  EXPECT_EQ(frames[0].utc_ns, expected.utc_ns);
  EXPECT_EQ(frames[0].device_time_s, expected.device_time_s);
  EXPECT_EQ(frames[0].sensor_temperature_c, expected.sensor_temperature_c);
  EXPECT_EQ(frames[0].turntable_deg, expected.turntable_deg);
  EXPECT_EQ(frames[0].light_elevation_deg, expected.light_elevation_deg);
  EXPECT_EQ(read_whole_file(store.frame_path(frames[0])), bytes);
  ASSERT_EQ(store.events().size(), 1u);
  EXPECT_EQ(store.events()[0].text, "hello");
  EXPECT_TRUE(store.journal_problems().empty());
}

TEST(SessionStore, NothingIsWrittenTwice) {
  const TemporaryFolder folder;
  SessionStore store = SessionStore::create(folder / "s", SessionKind::Captured);
  store.put_document("rig.toml", "a");
  EXPECT_THROW(store.put_document("rig.toml", "b"), Error);
  store.put_shots(two_shots());
  EXPECT_THROW(store.put_shots(two_shots()), Error);
  store.commit_frame(frame_for(two_shots()[0]), "first");
  NewFrame again = frame_for(two_shots()[0]);
  EXPECT_THROW(store.commit_frame(again, "second"), Error);
  again.name = "another.pgm";
  EXPECT_THROW(store.commit_frame(again, "second"), Error);  // the shot has its frame
  EXPECT_EQ(read_whole_file(store.directory() / "frames/000001_object.pgm"), "first");
  EXPECT_FALSE(fs::exists(store.directory() / "frames/another.pgm"));
}

TEST(SessionStore, WhatTheJournalRefusesLeavesNoFileOnceReopened) {
  const TemporaryFolder folder;
  std::optional<SessionStore> opened = SessionStore::create(folder / "s", SessionKind::Captured);
  SessionStore& store = *opened;
  store.put_shots(two_shots());
  NewFrame frame = frame_for(two_shots()[0]);
  frame.turntable_deg = std::nan("");
  EXPECT_THROW(store.commit_frame(frame, "bytes"), Error);
  frame = frame_for(two_shots()[0]);
  frame.shot_id = 77;  // no such shot
  EXPECT_THROW(store.commit_frame(frame, "bytes"), Error);
  for (const char* name : {"", ".hidden", "a/b", "../a"}) {
    frame.name = name;
    EXPECT_THROW(store.commit_frame(frame, "bytes"), Error);
  }
  opened.reset();
  opened = SessionStore::open(folder / "s", OpenMode::ReadWrite);
  EXPECT_TRUE(fs::is_empty(opened->directory() / "frames"));
  EXPECT_TRUE(opened->frames().empty());
}

TEST(SessionStore, OnlyOneWriterAtATime) {
  const TemporaryFolder folder;
  {
    const SessionStore writer = SessionStore::create(folder / "s", SessionKind::Captured);
    EXPECT_THROW(SessionStore::open(folder / "s", OpenMode::ReadWrite), Error);
    EXPECT_NO_THROW(SessionStore::open(folder / "s", OpenMode::ReadOnly));
  }
  EXPECT_NO_THROW(SessionStore::open(folder / "s", OpenMode::ReadWrite));
}

TEST(SessionStore, LeftoversGoWhenOpenedForWritingAndOnlyThen) {
  const TemporaryFolder folder;
  {
    SessionStore store = SessionStore::create(folder / "s", SessionKind::Captured);
    store.put_shots(two_shots());
    store.commit_frame(frame_for(two_shots()[0]), "kept");
  }
  const fs::path frames = folder / "s" / "frames";
  std::ofstream(partial_path(frames / "000002_dark.pgm")) << "half";
  std::ofstream(frames / "000002_dark.pgm") << "renamed, not committed";
  SessionStore::open(folder / "s", OpenMode::ReadOnly);
  EXPECT_TRUE(fs::exists(frames / "000002_dark.pgm"));
  SessionStore::open(folder / "s", OpenMode::ReadWrite);
  EXPECT_FALSE(fs::exists(frames / "000002_dark.pgm"));
  EXPECT_FALSE(fs::exists(partial_path(frames / "000002_dark.pgm")));
  EXPECT_EQ(read_whole_file(frames / "000001_object.pgm"), "kept");
}

TEST(SessionStore, WhatIsNoSessionIsRefused) {
  const TemporaryFolder folder;
  EXPECT_BAD_INPUT(SessionStore::open(folder / "none", OpenMode::ReadOnly), "none", "no session");
  std::ofstream(folder / "full.txt") << "x";
  EXPECT_BAD_INPUT(SessionStore::create(folder.path(), SessionKind::Captured), "exists already");
  EXPECT_BAD_INPUT(SessionStore::create(folder / "full.txt", SessionKind::Captured), "full.txt", "exists already");

  fs::create_directory(folder / "text");
  std::ofstream(folder / "text" / "session.db") << std::string(4096, 'x');
  EXPECT_THROW(SessionStore::open(folder / "text", OpenMode::ReadOnly), Corrupt);

  fs::create_directory(folder / "other");
  SqliteDatabase(folder / "other" / "session.db", DatabaseMode::Create).run("CREATE TABLE a (b)");
  EXPECT_THROW(SessionStore::open(folder / "other", OpenMode::ReadOnly), Corrupt);

  { SessionStore::create(folder / "newer", SessionKind::Imported); }
  SqliteDatabase(folder / "newer" / "session.db", DatabaseMode::ReadWrite).run("PRAGMA user_version = 99");
  EXPECT_THROW(SessionStore::open(folder / "newer", OpenMode::ReadWrite), Corrupt);
}

TEST(SessionStore, DiscardsComeBackAndAreNotContent) {
  const TemporaryFolder folder;
  SessionStore store = SessionStore::create(folder / "s", SessionKind::Captured);
  store.put_shots(two_shots());
  const std::string content = store.content_sha256();
  store.log_discard({2, 1, {0.25, 1.0}, CameraSettings{0.1 + 0.2, 2.0}, "late", 42});
  store.log_discard({2, 2, {0.25, 1.0}, std::nullopt, "unplugged", 43});
  EXPECT_THROW(store.log_discard({77, 1, {0.25, 1.0}, std::nullopt, "no such shot", 44}), Error);
  const std::vector<DiscardRecord> discards = store.discards();
  ASSERT_EQ(discards.size(), 2u);
  EXPECT_EQ(discards[0].shot_id, 2);
  EXPECT_EQ(discards[0].attempt, 1);
  EXPECT_EQ(discards[0].asked, (CameraSettings{0.25, 1.0}));
  EXPECT_EQ(discards[0].reported, (CameraSettings{0.1 + 0.2, 2.0}));
  EXPECT_EQ(discards[0].cause, "late");
  EXPECT_EQ(discards[0].utc_ns, 42);
  EXPECT_EQ(discards[1].attempt, 2);
  EXPECT_EQ(discards[1].reported, std::nullopt);
  EXPECT_EQ(store.content_sha256(), content);
}

TEST(SessionStore, OneOfTheFirstVersionIsReadAsItIsAndUpgradedByWriters) {
  const TemporaryFolder folder;
  {
    SessionStore store = SessionStore::create(folder / "s", SessionKind::Captured);
    store.put_shots(two_shots());
    store.commit_frame(frame_for(two_shots()[0]), "kept");
  }
  SqliteDatabase(folder / "s" / "session.db", DatabaseMode::ReadWrite)
      .run("DROP TABLE discards; DROP TABLE replayed_from; PRAGMA user_version = 1");
  std::string content;
  {
    const SessionStore store = SessionStore::open(folder / "s", OpenMode::ReadOnly);
    EXPECT_TRUE(store.discards().empty());
    EXPECT_EQ(store.replay_source(), std::nullopt);
    EXPECT_EQ(store.frames().size(), 1u);
    content = store.content_sha256();
  }
  SessionStore store = SessionStore::open(folder / "s", OpenMode::ReadWrite);
  store.log_discard({2, 1, {0.25, 1.0}, std::nullopt, "late", 42});
  EXPECT_EQ(store.discards().size(), 1u);
  EXPECT_EQ(store.content_sha256(), content);
}

TEST(SessionStore, AFullJournalSaysSo) {
  const TemporaryFolder folder;
  SqliteDatabase database(folder / "a.db", DatabaseMode::Create);
  database.run("CREATE TABLE t (b BLOB); PRAGMA max_page_count = 20");
  SqliteStatement insert = database.prepare("INSERT INTO t VALUES (?)");
  EXPECT_THROW(insert.with_blob(std::string(1 << 20, 'x')).step(), StorageFull);
}

TEST(SessionStore, AFullDiskSaysSoAndLeavesNothing) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "NOT TESTED: no /dev/full here";
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", partial_path(folder / "frame.pgm"));
  EXPECT_THROW(write_durably(folder / "frame.pgm", "bytes"), StorageFull);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(SessionStore, TheContentHashKnowsWhatWasMeasuredAndNotWhen) {
  const TemporaryFolder folder;
  const auto hash = [&](const std::string& name, const std::string& bytes, std::int64_t utc_ns, double turntable_deg) {
    SessionStore store = SessionStore::create(folder / name, SessionKind::Captured);
    store.put_shots(two_shots());
    NewFrame frame = frame_for(two_shots()[0]);
    frame.utc_ns = utc_ns;
    frame.turntable_deg = turntable_deg;
    store.commit_frame(frame, bytes);
    return store.content_sha256();
  };
  const std::string reference = hash("a", "bytes", 1, 2.0);
  EXPECT_EQ(hash("b", "bytes", 99, 2.0), reference);
  EXPECT_NE(hash("c", "other", 1, 2.0), reference);
  EXPECT_NE(hash("d", "bytes", 1, 2.0000000001), reference);
}

TEST(NewSession, IsThereWholeOrNotAtAll) {
  const TemporaryFolder folder;
  SessionContent content{{{"rig.toml", "r"}}, two_shots(), [](const fs::path& place) {
                           std::ofstream(place / "extra.txt") << "e";
                         }};
  fs::create_directories(folder / "s.preparing/frames");  // of an attempt that was killed
  {
    const SessionStore store = begin_session(folder / "s", content);
    EXPECT_EQ(store.missing_shots().size(), 2u);
    EXPECT_EQ(store.document("rig.toml"), "r");
    EXPECT_TRUE(fs::exists(folder / "s" / "extra.txt"));
  }
  EXPECT_BAD_INPUT(begin_session(folder / "s", content), "exists already");
  content.add_files = [](const fs::path&) { throw Error("no truth today"); };
  EXPECT_THROW(begin_session(folder / "t", content), Error);
  EXPECT_FALSE(fs::exists(folder / "t"));
  EXPECT_FALSE(fs::exists(folder / "t.preparing"));
  content.add_files = nullptr;
  fs::create_directory(folder / "empty");
  EXPECT_NO_THROW(begin_session((folder / "empty").string() + "/", content));
}

}  // namespace
}  // namespace lumitexel
