// The worker process that libgphoto2 lives in: started, spoken to with a deadline for each message, and killed.
//
// libgphoto2 blocks, and a camera can wedge it so that no call returns. Whatever goes wrong in an exchange, therefore
// (no answer in time, a stop request, an answer that makes no sense), the worker is killed; nothing of an exchange can
// then turn up in the next.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <string>

#include "drivers/clock.h"
#include "drivers/gphoto/worker_message.h"

namespace lumitexel {

// LUMITEXEL_GPHOTO_WORKER if that is set, else `lumitexel-gphoto-worker` beside the running program.
std::filesystem::path default_gphoto_worker();

class GphotoProcess {
 public:
  // name: the camera's, for messages. clock: a real one, as the worker's time is.
  GphotoProcess(std::string name, std::filesystem::path worker, std::shared_ptr<Clock> clock);
  ~GphotoProcess();
  GphotoProcess(const GphotoProcess&) = delete;
  GphotoProcess& operator=(const GphotoProcess&) = delete;

  // Starts a new worker, after killing the one that there is. Throws BadInput if there is no such program, Disconnected
  // if the system cannot start it.
  void start();
  // SIGKILL, and waits until it is gone: no zombie stays.
  void kill() noexcept;
  bool is_running() const { return pid_ > 0; }
  pid_t pid() const { return pid_; }  // 0: none

  // Throws what the answer says went wrong (Timeout, Disconnected, Protocol, OutOfRange, StorageFull; the worker lives
  // on), or, after killing the worker: Timeout for no answer within timeout_s, Cancelled, Disconnected if the worker
  // ended by itself or is not running, Protocol.
  WorkerMessage exchange(const WorkerMessage& request, double timeout_s, std::stop_token stop);

 private:
  struct Wait {
    std::string verb;
    double timeout_s, deadline_s;
    std::stop_token stop;
  };
  void send(std::span<const std::uint8_t> data, const Wait& wait) const;
  void receive(std::span<std::uint8_t> into, const Wait& wait) const;
  void wait_for(short what, const Wait& wait) const;
  [[noreturn]] void fail_ended(const Wait& wait) const;
  WorkerMessage exchanged(const WorkerMessage& request, const Wait& wait);
  void throw_failure(const WorkerMessage& answer, const std::string& verb) const;

  std::string name_;
  std::filesystem::path worker_, home_;
  std::shared_ptr<Clock> clock_;
  pid_t pid_ = 0;
  int socket_ = -1;
};

}  // namespace lumitexel
