#include "rig/safety_lane.h"

#include <pthread.h>

#include <iostream>
#include <sstream>
#include <utility>

namespace lumitexel {
namespace {

using SteadyTime = std::chrono::steady_clock::time_point;

constexpr std::chrono::milliseconds kRepeatUnacknowledged{20}, kRepeatAcknowledged{1000}, kLastGoodbye{1000};

// Before everything else on the machine, where we may (a privilege); else as everybody. Either way it is measured.
void prefer_this_thread() {
  sched_param priority{};
  priority.sched_priority = 10;
  pthread_setschedparam(pthread_self(), SCHED_RR, &priority);
}

}  // namespace

struct SafetyLane::Guard {
  std::unique_ptr<SafetyChannel> channel;
  bool safe = false;     // acknowledged since the trip; under the lane's mutex
  std::jthread thread;
};

SafetyLane::SafetyLane(std::vector<std::unique_ptr<SafetyChannel>> channels, std::chrono::milliseconds keep_alive_period)
    : keep_alive_period_(keep_alive_period) {
  for (std::unique_ptr<SafetyChannel>& channel : channels) {
    guards_.push_back(std::make_unique<Guard>());
    guards_.back()->channel = std::move(channel);
  }
  for (const std::unique_ptr<Guard>& one : guards_) {
    one->thread = std::jthread([this, &guarded = *one](std::stop_token stop) { guard(std::move(stop), guarded); });
  }
  watcher_ = std::jthread([this](std::stop_token stop) { watch(std::move(stop)); });
}

SafetyLane::~SafetyLane() {
  on_trip({});
  trip("the program lets go of the rig");
  {
    const std::lock_guard lock(mutex_);  // also when it had tripped before
    for (const std::unique_ptr<Guard>& one : guards_) one->safe = false;
    ++trips_;
  }
  changed_.notify_all();
  for (const std::string& name : wait_until_safe(kLastGoodbye)) {
    std::cerr << "lumitexel: NOT SAFE: " << name << " has not acknowledged lamps off and axes stopped; check by eye\n";
  }
}

void SafetyLane::trip(const std::string& cause) noexcept {
  try {
    const std::lock_guard lock(mutex_);
    if (tripped_) return;
    cause_ = cause;
    for (const std::unique_ptr<Guard>& one : guards_) one->safe = false;
    ++trips_;
    tripped_ = true;
  } catch (const std::exception&) {
    tripped_ = true;  // without its cause, which found no memory
  }
  changed_.notify_all();
}

std::string SafetyLane::cause() const {
  const std::lock_guard lock(mutex_);
  return tripped_ ? cause_ : "";
}

void SafetyLane::expect_life_within(std::chrono::duration<double> time, const std::string& doing) {
  const std::lock_guard lock(mutex_);
  doing_ = doing;
  life_time_ = time;
  life_due_ = time.count() <= 0.0
                  ? SteadyTime::max()
                  : std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::milliseconds>(time);
  changed_.notify_all();
}

void SafetyLane::on_trip(std::function<void()> listener) {
  const std::lock_guard lock(mutex_);
  listener_ = std::move(listener);
}

std::vector<std::string> SafetyLane::wait_until_safe(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  const auto all_safe = [this] {
    for (const std::unique_ptr<Guard>& one : guards_) {
      if (!one->safe) return false;
    }
    return true;
  };
  changed_.wait_for(lock, at_most, all_safe);
  std::vector<std::string> silent;
  for (const std::unique_ptr<Guard>& one : guards_) {
    if (!one->safe) silent.push_back(one->channel->name());
  }
  return silent;
}

void SafetyLane::reset() {
  const std::lock_guard lock(mutex_);
  tripped_ = false;
  cause_.clear();
  life_due_ = SteadyTime::max();
  changed_.notify_all();
}

// One controller. make_safe() is repeated after its acknowledgement: a command of the sequencer's that was under way
// when the lane tripped may have come after it.
void SafetyLane::guard(std::stop_token stop, Guard& guarded) {
  prefer_this_thread();
  SteadyTime last_heard = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (!tripped_) {
      lock.unlock();
      const bool heard = guarded.channel->keep_alive();
      const SteadyTime now = std::chrono::steady_clock::now();
      if (heard) last_heard = now;
      if (now - last_heard > std::chrono::duration<double>(kDeafChannel_s)) {
        trip(guarded.channel->name() + " no longer answers its safety connection");
      }
      lock.lock();
      changed_.wait_for(lock, stop, keep_alive_period_, [this] { return tripped_.load(); });
      continue;
    }
    const std::uint64_t trip = trips_;
    lock.unlock();
    const bool acknowledged = guarded.channel->make_safe();
    last_heard = std::chrono::steady_clock::now();
    lock.lock();
    if (acknowledged && trip == trips_ && !guarded.safe) {
      guarded.safe = true;
      changed_.notify_all();
    }
    changed_.wait_for(lock, stop, acknowledged ? kRepeatAcknowledged : kRepeatUnacknowledged,
                      [&] { return !tripped_ || trips_ != trip; });
  }
}

// Signs of life, and telling the listener: it may block, so no controller's thread does that.
void SafetyLane::watch(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (tripped_) {
      const std::uint64_t trip = trips_;
      const std::function<void()> listener = std::exchange(listener_, {});
      lock.unlock();
      if (listener) listener();
      lock.lock();
      changed_.wait(lock, stop, [&] { return !tripped_ || trips_ != trip; });
      continue;
    }
    const SteadyTime due = life_due_;
    if (due == SteadyTime::max()) {
      changed_.wait(lock, stop, [&] { return tripped_ || life_due_ != due; });
    } else if (!changed_.wait_until(lock, stop, due, [&] { return tripped_ || life_due_ != due; }) &&
               !stop.stop_requested()) {
      std::ostringstream text;
      text << doing_ << " has taken more than " << life_time_.count() << " s";
      lock.unlock();
      trip(text.str());
      lock.lock();
    }
  }
}

}  // namespace lumitexel
