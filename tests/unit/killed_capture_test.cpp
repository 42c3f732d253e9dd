// A capture that is killed, fifty times, without warning.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <random>
#include <set>

#include "drivers/clock.h"
#include "rig/new_session.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"
#include "rig/verify_session.h"
#include "rig/whole_file.h"
#include "tests/unit/fake_rig.h"
#include "tests/unit/small_rig.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

constexpr int kKills = 50;
constexpr double kMeanLife = 0.15;  // of an undisturbed capture's time: a session dies some five times on its way
constexpr int kFewestMidway = 15;  // kills that must meet a session with some frames and not all, or nothing was tested

void capture_or_resume(const fs::path& session) {
  const RigDescription rig = small_rig();
  SessionStore store = fs::exists(session)
                           ? SessionStore::open(session, OpenMode::ReadWrite)
                           : begin_session(session, {{{"rig.toml", small_rig_toml()}, {"plan.toml", small_plan_toml()}},
                                                     schedule_shots(small_plan(), rig, "plan.toml"),
                                                     nullptr});
  RigDevices devices = make_fake_devices(rig, std::make_shared<FakeBench>());
  NoProgress progress;
  take_missing_shots(store, devices, progress, {});
}

// Runs it in a process of its own and kills that after `delay_s`. True if it died of that, false if it was done before.
bool capture_killed_after(const fs::path& session, double delay_s) {
  SystemClock clock;
  const double deadline_s = clock.now_s() + delay_s;
  const pid_t child = fork();
  if (child == 0) {
    try {
      capture_or_resume(session);
      _exit(0);
    } catch (const std::exception& error) {
      fprintf(stderr, "%s\n", error.what());
      _exit(1);
    }
  }
  clock.sleep_until(deadline_s, {});
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return true;
  EXPECT_EQ(WEXITSTATUS(status), 0);
  return false;
}

struct Contents {
  std::map<std::string, std::string> files;  // of frames/
  std::string content_sha256;
};

Contents contents_of(const fs::path& session) {
  Contents contents;
  for (const fs::directory_entry& entry : fs::directory_iterator(session / "frames")) {
    contents.files[entry.path().filename().string()] = read_whole_file(entry.path());
  }
  contents.content_sha256 = SessionStore::open(session, OpenMode::ReadOnly).content_sha256();
  return contents;
}

// At any moment of its life: what the journal says is so.
// Returns how many frames there are.
std::int64_t expect_consistent_so_far(const fs::path& session) {
  if (!fs::exists(session)) return 0;  // killed before it was there: nothing happened
  NoProgress progress;
  const SessionStore store = SessionStore::open(session, OpenMode::ReadOnly);
  EXPECT_EQ(store.shots().size(), 27u);
  const SessionVerdict verdict = verify_session(store, progress);
  for (const SessionProblem& problem : verdict.problems) {
    const bool expected = problem.what.find("never taken") != std::string::npos ||
                          problem.what.find("not in the journal") != std::string::npos;
    EXPECT_TRUE(expected) << problem.file << ": " << problem.what;
  }
  return verdict.frames;
}

void expect_whole(const fs::path& session, const Contents& reference) {
  NoProgress progress;
  const SessionStore store = SessionStore::open(session, OpenMode::ReadOnly);
  for (const SessionProblem& problem : verify_session(store, progress).problems) {
    ADD_FAILURE() << problem.file << ": " << problem.what;
  }
  EXPECT_TRUE(store.missing_shots().empty());
  std::set<std::int64_t> shots;
  for (const FrameRecord& frame : store.frames()) EXPECT_TRUE(shots.insert(frame.shot_id).second) << frame.name;
  EXPECT_EQ(shots.size(), store.shots().size());
  const Contents contents = contents_of(session);
  EXPECT_EQ(contents.files, reference.files);
  EXPECT_EQ(contents.content_sha256, reference.content_sha256);
}

TEST(KilledCapture, LosesNothingAndTakesNothingTwice) {
  const TemporaryFolder folder;
  SystemClock clock;
  const double start_s = clock.now_s();
  capture_or_resume(folder / "reference");
  const double undisturbed_s = clock.now_s() - start_s;
  const Contents reference = contents_of(folder / "reference");
  ASSERT_EQ(reference.files.size(), 27u);

  std::mt19937 random(2);
  std::uniform_real_distribution<double> delay_s(0.0, 2.0 * kMeanLife * undisturbed_s);
  int kills = 0, midway = 0, sessions = 0;
  while (kills < kKills) {
    const fs::path session = folder / ("s" + std::to_string(sessions++));
    while (kills < kKills && capture_killed_after(session, delay_s(random))) {
      ++kills;
      const std::int64_t frames = expect_consistent_so_far(session);
      if (frames > 0 && frames < 27) ++midway;
    }
    capture_or_resume(session);
    expect_whole(session, reference);
  }
  RecordProperty("sessions", sessions);
  RecordProperty("killed_midway", midway);
  EXPECT_GE(midway, kFewestMidway);
}

}  // namespace
}  // namespace lumitexel
