// Who may talk on a line that several threads share: one at a time, and those with something urgent before all others.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace lumitexel {

class RequestTurns {
 public:
  // Held while a request is under way. taken() is false if the turn did not come within patience_s.
  class Turn {
   public:
    Turn(RequestTurns& turns, bool urgent, double patience_s) : turns_(turns), taken_(turns.take(urgent, patience_s)) {}
    ~Turn() {
      if (taken_) turns_.give_back();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    bool taken() const { return taken_; }

   private:
    RequestTurns& turns_;
    bool taken_;
  };

  // For whoever has the turn and could hand it over early.
  bool urgent_is_waiting() const {
    const std::lock_guard lock(mutex_);
    return urgent_waiting_ > 0;
  }

 private:
  bool take(bool urgent, double patience_s) {
    std::unique_lock lock(mutex_);
    urgent_waiting_ += urgent ? 1 : 0;
    const bool came = free_.wait_for(lock, std::chrono::duration<double>(patience_s),
                                     [&] { return !busy_ && (urgent || urgent_waiting_ == 0); });
    urgent_waiting_ -= urgent ? 1 : 0;
    if (came) busy_ = true;
    // An urgent one that has lost its patience no longer holds the others up.
    else if (urgent) free_.notify_all();
    return came;
  }
  void give_back() {
    {
      const std::lock_guard lock(mutex_);
      busy_ = false;
    }
    free_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable free_;
  bool busy_ = false;
  int urgent_waiting_ = 0;
};

}  // namespace lumitexel
