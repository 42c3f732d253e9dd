#include "drivers/aravis/aravis_device.h"

#include <mutex>

#include "drivers/aravis/gige_presence.h"
#include "drivers/error.h"

namespace lumitexel {
namespace {

// The library parses descriptions in static memory: two threads that open cameras at once destroy each other's.
std::mutex& parser_mutex() {
  static std::mutex mutex;
  return mutex;
}

GHandle<ArvCamera> open_gige(const std::string& address, const std::string& name) {
  const GHandle<GInetAddress> own(g_inet_address_new_from_string(own_address_facing(address, name).c_str()));
  const std::lock_guard parsing(parser_mutex());
  const GHandle<GInetAddress> remote(g_inet_address_new_from_string(address.c_str()));
  GErrorSlot error;
  const GHandle<ArvDevice> device(arv_gv_device_new(own.get(), remote.get(), error));
  error.require(name, "connecting");
  if (!device) throw Disconnected(name + ": connecting: nothing came back");
  if (!arv_gv_device_is_controller(ARV_GV_DEVICE(device.get()))) {
    throw Disconnected(name + ": connecting: asked for control, was refused; another program may have it");
  }
  GErrorSlot camera_error;
  GHandle<ArvCamera> camera(arv_camera_new_with_device(device.get(), camera_error));
  camera_error.require(name, "connecting");
  return camera;
}

GHandle<ArvCamera> open_by_id(const std::string& id, const std::string& name) {
  const std::lock_guard parsing(parser_mutex());
  GErrorSlot error;
  GHandle<ArvCamera> camera(arv_camera_new(id.c_str(), error));
  error.require(name, "connecting");
  return camera;
}

}  // namespace

AravisDevice::AravisDevice(const std::string& address, std::string name)
    : address_(address), name_(std::move(name)), camera_(is_ip_address(address) ? open_gige(address, name_) : open_by_id(address, name_)) {
  if (!camera_) throw Disconnected(name_ + ": connecting: no such camera");
  identity_ = read_identity();
  // By default the library accepts any number for any feature.
  arv_camera_set_range_check_policy(camera(), ARV_RANGE_CHECK_POLICY_ENABLE);
  signal_ = g_signal_connect(arv_camera_get_device(camera()), "control-lost", G_CALLBACK(on_control_lost),
                             &control_lost_);
}

AravisDevice::~AravisDevice() { g_signal_handler_disconnect(arv_camera_get_device(camera()), signal_); }

void AravisDevice::on_control_lost(ArvDevice*, std::atomic<bool>* lost) { *lost = true; }

void AravisDevice::take_control() {
  if (!is_gige()) return;
  GErrorSlot error;
  arv_gv_device_take_control(ARV_GV_DEVICE(arv_camera_get_device(camera())), error);
  error.require(name_, "taking control");
  control_lost_ = false;
}

std::string AravisDevice::read_identity() const {
  std::string identity;
  for (const char* feature : {"DeviceVendorName", "DeviceModelName", "DeviceSerialNumber"}) {
    if (has(feature)) identity += (identity.empty() ? "" : " ") + text(feature);
  }
  return identity;
}

void AravisDevice::require_present() const {
  if (is_gige()) own_address_facing(address_, name_);
}

void AravisDevice::require_same() const {
  const std::string now = read_identity();
  if (now != identity_) throw Disconnected(name_ + ": it was a " + identity_ + ", now a " + now + " answers");
}

GHandle<ArvChunkParser> AravisDevice::chunk_parser() const {
  const std::lock_guard parsing(parser_mutex());
  GHandle<ArvChunkParser> parser(arv_camera_create_chunk_parser(camera()));
  if (!parser) throw Protocol(name_ + ": asked how to read its chunks, its description does not say");
  return parser;
}

bool AravisDevice::has(const std::string& feature) const {
  return call("is there " + feature, arv_camera_is_feature_available, feature.c_str());
}

std::vector<std::string> AravisDevice::choices(const std::string& feature) const {
  guint count = 0;
  GErrorSlot error;
  const std::unique_ptr<const char*[], GFree> names(
      arv_camera_dup_available_enumerations_as_strings(camera(), feature.c_str(), &count, error));
  error.require(name_, "choices of " + feature);
  return names ? std::vector<std::string>(names.get(), names.get() + count) : std::vector<std::string>{};
}

std::int64_t AravisDevice::integer(const std::string& feature) const {
  return call("reading " + feature, arv_camera_get_integer, feature.c_str());
}

double AravisDevice::real(const std::string& feature) const {
  return call("reading " + feature, arv_camera_get_float, feature.c_str());
}

std::string AravisDevice::text(const std::string& feature) const {
  const char* value = call("reading " + feature, arv_camera_get_string, feature.c_str());
  return value == nullptr ? "" : value;
}

void AravisDevice::set(const std::string& feature, std::int64_t value) const {
  call("setting " + feature + " to " + std::to_string(value), arv_camera_set_integer, feature.c_str(), value);
}

void AravisDevice::set_verified(const std::string& feature, const std::string& choice) const {
  call("setting " + feature + " to " + choice, arv_camera_set_string, feature.c_str(), choice.c_str());
  const std::string now = text(feature);
  if (now != choice) throw Protocol(name_ + ": set " + feature + " to " + choice + ", it reads back " + now);
}

void AravisDevice::execute(const std::string& command) const {
  call("executing " + command, arv_camera_execute_command, command.c_str());
}

}  // namespace lumitexel
