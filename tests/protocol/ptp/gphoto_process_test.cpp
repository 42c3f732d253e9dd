// The worker process: gone when it must be, never left over, never waited for.
#include "drivers/gphoto/gphoto_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <functional>
#include <thread>

#include "drivers/error.h"
#include "tests/protocol/ptp/still_bench.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const std::shared_ptr<Clock> kClock = std::make_shared<SystemClock>();

std::unique_ptr<GphotoCamera> connected(const PtpCameraServer& server, double answer_timeout_s = 5.0) {
  return std::make_unique<GphotoCamera>(connection_to(server, answer_timeout_s), still_rig().camera.limits, kClock,
                                        LUMITEXEL_GPHOTO_WORKER);
}

bool soon(const std::function<bool()>& condition, double within_s = 5.0) {
  for (const double deadline_s = kClock->now_s() + within_s; kClock->now_s() < deadline_s;) {
    if (condition()) return true;
    kClock->sleep_until(kClock->now_s() + 0.01, {});
  }
  return condition();
}

// Neither a running nor a dead child waits to be collected.
bool has_no_children() { return waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD; }

// Where workers' HOMEs are made while it exists.
class TemporaryPlace {
 public:
  TemporaryPlace() { setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~TemporaryPlace() { unsetenv("TMPDIR"); }
  bool is_empty() const { return std::filesystem::is_empty(folder_.path()); }

 private:
  TemporaryFolder folder_;
};

TEST(GphotoProcess, LeavesNothingBehind) {
  const TemporaryPlace place;
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  auto camera = connected(*server);
  camera->shoot({0.004, 0.0}, {}, 1);
  const pid_t worker = camera->worker_pid();
  EXPECT_TRUE(is_alive(worker));
  EXPECT_FALSE(place.is_empty());
  camera.reset();
  EXPECT_FALSE(is_alive(worker));
  EXPECT_TRUE(has_no_children());
  EXPECT_TRUE(place.is_empty());
}

TEST(GphotoProcess, AWedgedWorkerIsKilledAndAnotherStarted) {
  const TemporaryPlace place;
  // The first capture is accepted and never ends.
  const auto faults = std::make_shared<OneFault>("camera", Fault::Wedge, 1);
  const auto server = serve(still_bench(), faults);
  auto camera = connected(*server, 1.0);
  const pid_t wedged = camera->worker_pid();
  const double start_s = kClock->now_s();
  const Frame frame = camera->shoot({0.004, 0.0}, {}, 9);
  EXPECT_LT(kClock->now_s() - start_s, 6.0);
  EXPECT_EQ(objection_to(frame, {0.004, 0.0}, 9), "");
  EXPECT_NE(camera->worker_pid(), wedged);
  EXPECT_FALSE(is_alive(wedged));
  camera.reset();
  EXPECT_TRUE(has_no_children());
  EXPECT_TRUE(place.is_empty());
}

TEST(GphotoProcess, AStoppedWorkerIsKilledAndAnotherStarted) {
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  const auto camera = connected(*server, 1.0);
  for (const int signal : {SIGSTOP, SIGKILL, SIGSEGV}) {
    const pid_t struck = camera->worker_pid();
    ::kill(struck, signal);
    EXPECT_EQ(objection_to(camera->shoot({0.004, 0.0}, {}, 5), {0.004, 0.0}, 5), "");
    EXPECT_FALSE(is_alive(struck));
  }
}

TEST(GphotoProcess, AStopRequestEndsTheWaitForAnExposure) {
  const auto server = serve(still_bench(still_rig(), 20.0), std::make_shared<NoFaults>());
  const auto camera = connected(*server);
  std::stop_source stop;
  std::jthread stopper([&] {
    kClock->sleep_until(kClock->now_s() + 0.4, {});
    stop.request_stop();
  });
  const double start_s = kClock->now_s();
  EXPECT_THROW(camera->shoot({30.0, 0.0}, stop.get_token(), 1), Cancelled);
  EXPECT_LT(kClock->now_s() - start_s, 1.2);  // the exposure takes 1.5 s here
  EXPECT_EQ(camera->worker_pid(), 0);
  kClock->sleep_until(start_s + 1.8, {});
  EXPECT_EQ(objection_to(camera->shoot({0.004, 0.0}, {}, 2), {0.004, 0.0}, 2), "");
}

// In the middle of a call that does not return.
TEST(GphotoProcess, TheWorkerEndsWithItsParentEvenIfThatIsKilled) {
  const auto server = serve(still_bench(), std::make_shared<OneFault>("camera", Fault::Wedge, 1));
  const GphotoConnection connection = connection_to(*server, 60.0);
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    GphotoCamera camera(connection, still_rig().camera.limits, kClock, LUMITEXEL_GPHOTO_WORKER);
    const pid_t worker = camera.worker_pid();
    if (write(pipe_ends[1], &worker, sizeof worker) == sizeof worker) camera.shoot({0.004, 0.0}, {}, 1);
    _exit(1);
  }
  pid_t worker = 0;
  ASSERT_EQ(read(pipe_ends[0], &worker, sizeof worker), static_cast<ssize_t>(sizeof worker));
  close(pipe_ends[0]);
  close(pipe_ends[1]);
  kClock->sleep_until(kClock->now_s() + 0.5, {});
  EXPECT_TRUE(is_alive(worker));
  ::kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(soon([&] { return !is_alive(worker); }));
}

TEST(GphotoProcess, AMissingWorkerIsSaid) {
  GphotoProcess process("camera", "/no/such/program", kClock);
  EXPECT_THROW(process.start(), BadInput);
  EXPECT_THROW(process.exchange({{{"verb", "get"}}, {}, {}}, 1.0, {}), Disconnected);
}

// Programs that are no worker: one that ends at once, one that never answers, one that answers nonsense.
TEST(GphotoProcess, OtherProgramsAnswersAreFaults) {
  const TemporaryFolder folder;
  const auto exchange_with = [&](const std::string& script) {
    const auto program = folder / "worker";
    std::filesystem::remove(program);
    FILE* file = std::fopen(program.c_str(), "w");
    std::fputs(("#!/bin/sh\n" + script + "\n").c_str(), file);
    std::fclose(file);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    GphotoProcess process("camera", program, kClock);
    process.start();
    try {
      process.exchange({{{"verb", "get"}}, {}, {}}, 0.5, {});
    } catch (...) {
      EXPECT_FALSE(process.is_running());
      throw;
    }
  };
  EXPECT_THROW(exchange_with("exit 0"), Disconnected);
  EXPECT_THROW(exchange_with("exec sleep 30"), Timeout);
  EXPECT_THROW(exchange_with("head -c 100 /dev/urandom >&3; exec sleep 30"), Protocol);
  EXPECT_THROW(exchange_with("printf '\\005\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0{\"a\":' >&3; exec sleep 30"), Protocol);
  EXPECT_THROW(exchange_with("printf '\\005\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0{}' >&3; exec sleep 30"), Timeout);
  EXPECT_TRUE(has_no_children());
}

TEST(GphotoCamera, ComesBackWhenItIsPluggedInAgain) {
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  const auto camera = connected(*server);
  camera->shoot({0.004, 0.0}, {}, 1);
  server->plug(false);
  std::jthread hand([&] {
    kClock->sleep_until(kClock->now_s() + 1.0, {});
    server->plug(true);
  });
  const double start_s = kClock->now_s();
  EXPECT_EQ(objection_to(camera->shoot({0.0333, 0.0}, {}, 2), {0.0333, 0.0}, 2), "");
  EXPECT_GT(kClock->now_s() - start_s, 0.9);
  EXPECT_LT(kClock->now_s() - start_s, 5.0);
}

TEST(GphotoCamera, SaysWithinItsTimeThatItIsGone) {
  const auto server = serve(still_bench(), std::make_shared<NoFaults>());
  GphotoConnection connection = connection_to(*server, 1.0);
  connection.reconnect_timeout_s = 1.0;
  GphotoCamera camera(connection, still_rig().camera.limits, kClock, LUMITEXEL_GPHOTO_WORKER);
  server->plug(false);
  const double start_s = kClock->now_s();
  try {
    camera.shoot({0.004, 0.0}, {}, 1, 2);
    FAIL() << "took a picture with a camera that is not there";
  } catch (const Disconnected& error) {
    EXPECT_NE(std::string(error.what()).find(server->gphoto_port()), std::string::npos) << error.what();
  }
  EXPECT_LT(kClock->now_s() - start_s, 5.0);
}

}  // namespace
}  // namespace lumitexel
