// Lamps off and axes stopped, whatever the rest of the program is doing: threads and connections of its own, one of
// each per controller, so that neither storage nor images nor a dead controller stand in the way.
//
//          trip(cause), or no sign of life in time
//   Watching ────────────────────────────────────▶ Tripped: make_safe() until acknowledged, then again every second
//      │ keep_alive() every period: the controller's own watchdog trips if this program dies or starves;
//      │ a controller that has not answered kDeafChannel_s long trips the lane
//
// Works in real time, not on the injected Clock: what it guards against is real.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace lumitexel {

// A connection to one controller that is used for nothing else.
class SafetyChannel {
 public:
  virtual ~SafetyChannel() = default;
  virtual std::string name() const = 0;
  // Every lamp off, every axis stopped; true once the controller has acknowledged all of it. Takes at most some 100 ms.
  virtual bool make_safe() noexcept = 0;
  // Feeds the controller's watchdog where it has one, and keeps the connection warm; true if the controller answered.
  virtual bool keep_alive() noexcept = 0;
};

inline constexpr double kDeafChannel_s = 2.0;

class SafetyLane {
 public:
  // keep_alive_period: well below the controllers' watchdog times.
  explicit SafetyLane(std::vector<std::unique_ptr<SafetyChannel>> channels,
                      std::chrono::milliseconds keep_alive_period = std::chrono::milliseconds(200));
  // Makes everything safe for a last time, waits for that at most a second, ends the threads. Who does not acknowledge is
  // named on stderr: there is nobody left to throw to.
  ~SafetyLane();
  SafetyLane(const SafetyLane&) = delete;
  SafetyLane& operator=(const SafetyLane&) = delete;

  // From any thread; returns at once. The first cause is kept.
  void trip(const std::string& cause) noexcept;
  bool is_tripped() const noexcept { return tripped_.load(); }
  std::string cause() const;  // empty while not tripped

  // From now on a sign of life, which is the next call of this, is due within this time, or the lane trips and says that
  // `doing` took too long. Zero: none is due.
  void expect_life_within(std::chrono::duration<double> time, const std::string& doing);

  // Called once on tripping, from a thread of the lane that has nothing else to do.
  void on_trip(std::function<void()> listener);

  // Waits until every controller has acknowledged, at most so long; returns the names of those that have not.
  std::vector<std::string> wait_until_safe(std::chrono::milliseconds at_most);

  // Back to watching, for the next session.
  void reset();

 private:
  struct Guard;  // a channel and its thread
  void guard(std::stop_token stop, Guard& guarded);
  void watch(std::stop_token stop);

  std::chrono::milliseconds keep_alive_period_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::atomic<bool> tripped_ = false;
  std::uint64_t trips_ = 0;  // so far: a trip right after a reset is another one
  std::string cause_, doing_;
  std::chrono::steady_clock::time_point life_due_ = std::chrono::steady_clock::time_point::max();
  std::chrono::duration<double> life_time_{};
  std::function<void()> listener_;
  std::vector<std::unique_ptr<Guard>> guards_;
  std::jthread watcher_;
};

}  // namespace lumitexel
