// A camera in the worker process, verb by verb, each with its deadline. Knows when its connection can no longer be
// trusted.
#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "drivers/clock.h"
#include "drivers/gphoto/gphoto_connection.h"
#include "drivers/gphoto/gphoto_process.h"

namespace lumitexel {

struct DownloadedPicture {
  std::string file;  // its name on the card
  std::vector<std::uint8_t> bytes;
};

// Every member but disconnect() throws Timeout, Disconnected, Protocol, OutOfRange, StorageFull or Cancelled, naming
// the camera, and leaves it unconnected except after OutOfRange and StorageFull.
class RemoteCamera {
 public:
  RemoteCamera(std::string name, GphotoConnection connection, std::filesystem::path worker,
               std::shared_ptr<Clock> clock);

  // A new worker, a new connection, the fixed settings made and read back, the dials' choices read. Tries again until
  // reconnect_timeout_s have passed, then throws Disconnected. Throws OutOfRange at once for a model or a port that
  // libgphoto2 does not know.
  void connect(std::stop_token stop);
  bool is_connected() const { return connected_ && process_.is_running(); }
  void disconnect() noexcept;

  // As they were on connecting; never empty then.
  const std::vector<std::string>& exposure_choices() const { return exposure_choices_; }
  const std::vector<std::string>& gain_choices() const { return gain_choices_; }
  // Sets it unless it is so already; returns what it reads back.
  std::string set(const std::string& setting, const std::string& value, std::stop_token stop);
  // Takes a picture, fetches it and deletes it on the card. A picture that cannot be deleted is a picture all the same.
  DownloadedPicture take_picture(double exposure_s, std::stop_token stop);

  pid_t worker_pid() const { return process_.pid(); }

 private:
  WorkerMessage ask(WorkerMessage request, double timeout_s, std::stop_token stop);
  void try_to_connect(std::stop_token stop);
  std::vector<std::string> choices(const std::string& setting, std::stop_token stop);
  void require_time_left(double deadline_s, const std::string& last_failure) const;

  std::string name_;
  GphotoConnection connection_;
  std::shared_ptr<Clock> clock_;
  GphotoProcess process_;
  bool connected_ = false;
  std::vector<std::string> exposure_choices_, gain_choices_;
};

}  // namespace lumitexel
