#include "drivers/gphoto/remote_camera.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kPauseBetweenTries_s = 0.1;
// The worker gives up waiting for a picture by itself, but only after its parent would have: its answer could be lost
// else.
constexpr double kWorkerGrace_s = 1.0;

}  // namespace

RemoteCamera::RemoteCamera(std::string name, GphotoConnection connection, std::filesystem::path worker,
                           std::shared_ptr<Clock> clock)
    : name_(std::move(name)),
      connection_(std::move(connection)),
      clock_(clock),
      process_(name_, std::move(worker), std::move(clock)) {}

WorkerMessage RemoteCamera::ask(WorkerMessage request, double timeout_s, std::stop_token stop) {
  try {
    return process_.exchange(request, timeout_s, stop);
  } catch (const OutOfRange&) {
    throw;
  } catch (const StorageFull&) {
    throw;
  } catch (const Error&) {
    connected_ = false;
    throw;
  }
}

void RemoteCamera::disconnect() noexcept {
  connected_ = false;
  process_.kill();
}

void RemoteCamera::connect(std::stop_token stop) {
  const double deadline_s = clock_->now_s() + connection_.reconnect_timeout_s;
  while (true) {
    disconnect();
    try {
      return try_to_connect(stop);
    } catch (const Timeout& error) {
      require_time_left(deadline_s, error.what());
    } catch (const Disconnected& error) {
      require_time_left(deadline_s, error.what());
    } catch (const Protocol& error) {
      require_time_left(deadline_s, error.what());
    }
    clock_->sleep_until(clock_->now_s() + kPauseBetweenTries_s, stop);
  }
}

void RemoteCamera::require_time_left(double deadline_s, const std::string& last_failure) const {
  if (clock_->now_s() + kPauseBetweenTries_s < deadline_s) return;
  std::ostringstream text;
  text << name_ << ": not connected within " << connection_.reconnect_timeout_s
       << " s; check its cable, its power and that no other program uses it. The last try: " << last_failure;
  throw Disconnected(text.str());
}

void RemoteCamera::try_to_connect(std::stop_token stop) {
  process_.start();
  const double timeout_s = std::min(connection_.answer_timeout_s, connection_.reconnect_timeout_s);
  ask({{{"verb", "open"}, {"model", connection_.model}, {"port", connection_.port}}, {}, {}}, timeout_s, stop);
  connected_ = true;
  for (const auto& [setting, value] : connection_.fixed_settings) {
    const std::string read_back = set(setting, value, stop);
    if (read_back == value) continue;
    connected_ = false;
    throw Protocol(name_ + ": '" + setting + "' set to '" + value + "', reads back '" + read_back + "'");
  }
  exposure_choices_ = choices(connection_.exposure_setting, stop);
  gain_choices_ = choices(connection_.gain_setting, stop);
}

std::vector<std::string> RemoteCamera::choices(const std::string& setting, std::stop_token stop) {
  auto texts = ask({{{"verb", "choices"}, {"name", setting}}, {}, {}}, connection_.answer_timeout_s, stop).texts;
  if (!texts.empty()) return texts;
  throw Protocol(name_ + ": '" + setting + "' has no choices; is the camera set to manual exposure?");
}

std::string RemoteCamera::set(const std::string& setting, const std::string& value, std::stop_token stop) {
  const auto get = [&] {
    return ask({{{"verb", "get"}, {"name", setting}}, {}, {}}, connection_.answer_timeout_s, stop).field("value");
  };
  if (get() == value) return value;
  ask({{{"verb", "set"}, {"name", setting}, {"value", value}}, {}, {}}, connection_.answer_timeout_s, stop);
  return get();
}

DownloadedPicture RemoteCamera::take_picture(double exposure_s, std::stop_token stop) {
  const double timeout_s = exposure_s + connection_.answer_timeout_s;
  const WorkerMessage taken =
      ask({{{"verb", "capture"}, {"timeout_s", std::to_string(timeout_s + kWorkerGrace_s)}}, {}, {}}, timeout_s, stop);
  const std::string& folder = taken.field("folder");
  const std::string& file = taken.field("file");
  DownloadedPicture picture{file, {}};
  picture.bytes =
      ask({{{"verb", "download"}, {"folder", folder}, {"file", file}}, {}, {}}, connection_.answer_timeout_s, stop)
          .bytes;
  try {
    ask({{{"verb", "remove"}, {"folder", folder}, {"file", file}}, {}, {}}, connection_.answer_timeout_s, stop);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error&) {
    // The picture is here. If the connection broke, the next picture begins with a new one.
  }
  return picture;
}

}  // namespace lumitexel
