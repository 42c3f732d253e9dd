#include "rig/verify_session.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "rig/new_session.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"
#include "rig/sqlite_database.h"
#include "rig/whole_file.h"
#include "tests/unit/fake_rig.h"
#include "tests/unit/small_rig.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

class VerifySession : public testing::Test {
 protected:
  // Photographed once; every test damages a copy of its own.
  static void SetUpTestSuite() {
    original_ = std::make_unique<TemporaryFolder>();
    const std::vector<Shot> shots = schedule_shots(small_plan(), small_rig(), "plan.toml");
    SessionStore store = begin_session(
        *original_ / "s", {{{"rig.toml", small_rig_toml()}, {"plan.toml", small_plan_toml()}}, shots, nullptr});
    RigDevices devices = make_fake_devices(small_rig(), std::make_shared<FakeBench>());
    NoProgress progress;
    take_missing_shots(store, devices, progress, {});
  }
  static void TearDownTestSuite() { original_.reset(); }
  VerifySession() { fs::copy(*original_ / "s", session_, fs::copy_options::recursive); }

  SessionVerdict verdict() const {
    NoProgress progress;
    return verify_session(SessionStore::open(session_, OpenMode::ReadOnly), progress);
  }
  // Exactly one problem, of this file, whose text holds this part.
  void expect_problem(const std::string& file, const std::string& part) const {
    const SessionVerdict found = verdict();
    EXPECT_FALSE(found.ok());
    ASSERT_EQ(found.problems.size(), 1u);
    EXPECT_EQ(found.problems[0].file, file);
    EXPECT_NE(found.problems[0].what.find(part), std::string::npos) << found.problems[0].what;
  }
  void change_journal(const std::string& sql) const {
    SqliteDatabase(session_ / "session.db", DatabaseMode::ReadWrite).run(sql);
  }
  void rewrite(const fs::path& path, const std::string& bytes) const {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }

  inline static std::unique_ptr<TemporaryFolder> original_;
  TemporaryFolder folder_;
  fs::path session_ = folder_ / "s";
  fs::path frame_ = session_ / "frames" / "000004_object.pgm";
};

TEST_F(VerifySession, AnUntouchedSessionIsOk) {
  const SessionVerdict found = verdict();
  EXPECT_TRUE(found.ok()) << found.problems.front().file << ": " << found.problems.front().what;
  EXPECT_EQ(found.frames, 27);
}

TEST_F(VerifySession, FindsAFlippedBit) {
  std::string bytes = read_whole_file(frame_);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  rewrite(frame_, bytes);
  expect_problem("frames/000004_object.pgm", "hash");
}

TEST_F(VerifySession, FindsATruncatedFile) {
  const std::string bytes = read_whole_file(frame_);
  rewrite(frame_, bytes.substr(0, bytes.size() - 1));
  expect_problem("frames/000004_object.pgm", "bytes");
}

TEST_F(VerifySession, FindsADeletedFile) {
  fs::remove(frame_);
  expect_problem("frames/000004_object.pgm", "missing");
}

TEST_F(VerifySession, FindsAFileThatNobodyJournalled) {
  rewrite(session_ / "frames" / "holiday.pgm", "P5");
  expect_problem("frames/holiday.pgm", "not in the journal");
}

TEST_F(VerifySession, FindsAShotWithoutFrame) {
  change_journal("DELETE FROM frames WHERE shot_id = 4");
  fs::remove(frame_);
  expect_problem("frames/000004_object.pgm", "never taken");
}

TEST_F(VerifySession, FindsADocumentThatChanged) {
  change_journal("UPDATE documents SET bytes = x'00' WHERE name = 'plan.toml'");
  expect_problem("session.db", "plan.toml does not match its hash");
}

TEST_F(VerifySession, FindsSettingsThatAreNotTheShots) {
  change_journal("UPDATE frames SET reported_exposure_s = 9 WHERE shot_id = 4");
  expect_problem("frames/000004_object.pgm", "reported 9 s");
}

TEST_F(VerifySession, FindsAnAxisThatStoodElsewhere) {
  change_journal("UPDATE frames SET light_azimuth_deg = light_azimuth_deg + 1 WHERE shot_id = 4");
  expect_problem("frames/000004_object.pgm", "light azimuth");
}

TEST_F(VerifySession, FindsAFrameUnderTheWrongRole) {
  change_journal("UPDATE frames SET role = 'dark' WHERE shot_id = 4");
  expect_problem("frames/000004_object.pgm", "is a dark");
}

}  // namespace
}  // namespace lumitexel
