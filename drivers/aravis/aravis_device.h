// A connected camera of the library: opened by address, its features by name, its errors by cause. Only for the .cpp
// files of this folder.
//
// A command to a device that does not answer fails after about 2.5 s, five tries of the library; it cannot be cut short.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "drivers/aravis/aravis_handle.h"

namespace lumitexel {

class AravisDevice {
 public:
  // address: an IP address, or a USB3 Vision camera's id. Connects and takes control. Throws Timeout, Disconnected (not
  // found, or controlled by somebody else), Protocol.
  AravisDevice(const std::string& address, std::string name);
  ~AravisDevice();
  AravisDevice(const AravisDevice&) = delete;
  AravisDevice& operator=(const AravisDevice&) = delete;

  const std::string& name() const { return name_; }
  ArvCamera* camera() const { return camera_.get(); }
  bool is_gige() const { return arv_camera_is_gv_device(camera_.get()); }
  // Set once the camera's heartbeat has failed or showed that somebody else is in control.
  bool control_lost() const { return control_lost_; }
  void take_control();  // again; throws Timeout, Disconnected

  // Throws Disconnected within about a second if a GigE Vision camera does not answer at all.
  void require_present() const;
  // Throws Disconnected if another camera than the one that was opened answers by now.
  void require_same() const;
  // Throws Protocol.
  GHandle<ArvChunkParser> chunk_parser() const;

  // All of these throw Timeout, Disconnected, Protocol, the setters OutOfRange too.
  bool has(const std::string& feature) const;
  std::vector<std::string> choices(const std::string& feature) const;
  std::int64_t integer(const std::string& feature) const;
  double real(const std::string& feature) const;
  std::string text(const std::string& feature) const;
  void set(const std::string& feature, std::int64_t value) const;
  // Sets and reads back. Throws Protocol if the camera then says something else.
  void set_verified(const std::string& feature, const std::string& choice) const;
  void execute(const std::string& command) const;

  // Calls a function of the library with this camera, arguments and an error; throws by its error.
  template <class Function, class... Arguments>
  auto call(const std::string& asked, Function function, Arguments... arguments) const {
    GErrorSlot error;
    if constexpr (std::is_void_v<decltype(function(camera_.get(), arguments..., error))>) {
      function(camera_.get(), arguments..., error);
      error.require(name_, asked);
    } else {
      const auto result = function(camera_.get(), arguments..., error);
      error.require(name_, asked);
      return result;
    }
  }

 private:
  std::string read_identity() const;
  static void on_control_lost(ArvDevice* device, std::atomic<bool>* lost);

  std::string address_, name_;
  GHandle<ArvCamera> camera_;
  std::atomic<bool> control_lost_ = false;
  unsigned long signal_ = 0;
  std::string identity_;
};

}  // namespace lumitexel
