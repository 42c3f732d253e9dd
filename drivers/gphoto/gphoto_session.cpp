#include "drivers/gphoto/gphoto_session.h"

#include <gphoto2/gphoto2.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <optional>
#include <utility>

#include "drivers/clock.h"
#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kBusyPause_s = 0.05;

template <class Handle, int (*Release)(Handle*)>
struct Releaser {
  void operator()(Handle* handle) const { Release(handle); }
};
using OwnedWidget = std::unique_ptr<CameraWidget, Releaser<CameraWidget, gp_widget_free>>;
using OwnedFile = std::unique_ptr<CameraFile, Releaser<CameraFile, gp_file_unref>>;
using OwnedPorts = std::unique_ptr<GPPortInfoList, Releaser<GPPortInfoList, gp_port_info_list_free>>;
using OwnedModels = std::unique_ptr<CameraAbilitiesList, Releaser<CameraAbilitiesList, gp_abilities_list_free>>;

// The library's return values say little ("Unspecified error"); what it logs names PTP's own code.
std::string last_log;
void keep_log(GPLogLevel, const char*, const char* text, void*) { last_log = text; }

bool log_mentions(const char* ptp_code) { return last_log.find(ptp_code) != std::string::npos; }

// While it exists. With any listener at all, libgphoto2 spells out every byte of a file for its log: a third of a
// transfer's time. Downloads therefore go without.
class LogKeeper {
 public:
  LogKeeper() : id_(gp_log_add_func(GP_LOG_ERROR, keep_log, nullptr)) { last_log.clear(); }
  ~LogKeeper() { gp_log_remove_func(id_); }
  LogKeeper(const LogKeeper&) = delete;
  LogKeeper& operator=(const LogKeeper&) = delete;

 private:
  int id_;
};

int checked(int code, const std::string& what) {
  if (code >= GP_OK) return code;
  const std::string text = what + ": libgphoto2 says '" + gp_result_as_string(code) + "' (" + std::to_string(code) +
                           ")" + (last_log.empty() ? "" : ", before it: " + last_log);
  if (code == GP_ERROR_NO_SPACE || log_mentions("0x200c") || log_mentions("0x200C")) throw StorageFull(text);
  switch (code) {
    case GP_ERROR_TIMEOUT:
      throw Timeout(text);
    case GP_ERROR_IO:
    case GP_ERROR_IO_INIT:
    case GP_ERROR_IO_READ:
    case GP_ERROR_IO_WRITE:
    case GP_ERROR_IO_USB_FIND:
    case GP_ERROR_IO_USB_CLAIM:
      throw Disconnected(text);
    case GP_ERROR_MODEL_NOT_FOUND:
    case GP_ERROR_UNKNOWN_PORT:
      throw OutOfRange(text);
    default:
      throw Protocol(text);
  }
}

bool is_jpeg(const std::string& name) {
  std::string end = name.substr(name.find_last_of('.') + 1);
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  return end == "jpg" || end == "jpeg";
}

}  // namespace

struct GphotoSession::Library {
  GPContext* context = gp_context_new();
  ::Camera* camera = nullptr;
  SystemClock clock;

  ~Library() {
    if (camera != nullptr) gp_camera_unref(camera);
    gp_context_unref(context);
  }

  void choose_model(const std::string& model) {
    CameraAbilitiesList* list = nullptr;
    checked(gp_abilities_list_new(&list), "list of models");
    const OwnedModels models(list);
    checked(gp_abilities_list_load(list, context), "list of models");
    CameraAbilities abilities;
    const int at = checked(gp_abilities_list_lookup_model(list, model.c_str()), "model '" + model + "'");
    checked(gp_abilities_list_get_abilities(list, at, &abilities), "model '" + model + "'");
    checked(gp_camera_set_abilities(camera, abilities), "model '" + model + "'");
  }

  void choose_port(const std::string& port) {
    GPPortInfoList* list = nullptr;
    checked(gp_port_info_list_new(&list), "list of ports");
    const OwnedPorts ports(list);
    checked(gp_port_info_list_load(list), "list of ports");
    GPPortInfo info;
    const int at = checked(gp_port_info_list_lookup_path(list, port.c_str()), "port '" + port + "'");
    checked(gp_port_info_list_get_info(list, at, &info), "port '" + port + "'");
    checked(gp_camera_set_port_info(camera, info), "port '" + port + "'");
  }

  // A setting and its type: text, a choice, a switch or a range.
  std::pair<OwnedWidget, CameraWidgetType> setting(const std::string& name) {
    CameraWidget* found = nullptr;
    checked(gp_camera_get_single_config(camera, name.c_str(), &found, context), "setting '" + name + "'");
    OwnedWidget widget(found);
    CameraWidgetType type{};
    checked(gp_widget_get_type(found, &type), "setting '" + name + "'");
    if (type == GP_WIDGET_DATE || type == GP_WIDGET_BUTTON || type == GP_WIDGET_SECTION || type == GP_WIDGET_WINDOW) {
      throw OutOfRange("setting '" + name + "': it has no text");
    }
    return {std::move(widget), type};
  }

  // A camera may be busy with the picture before, and is asked again until it is not.
  void release_shutter(double deadline_s) {
    while (true) {
      const int code = gp_camera_trigger_capture(camera, context);
      if (code != GP_ERROR_CAMERA_BUSY || clock.now_s() > deadline_s) {
        checked(code, "releasing the shutter");
        return;
      }
      clock.sleep_until(clock.now_s() + kBusyPause_s, {});
    }
  }

  // One thing that the camera reports within wait_ms; a new file's path if it is that.
  std::optional<CardPath> next_file(int wait_ms, CameraEventType& type) {
    void* data = nullptr;
    checked(gp_camera_wait_for_event(camera, wait_ms, &type, &data, context), "waiting for the picture");
    const std::unique_ptr<void, decltype(&std::free)> owned(data, &std::free);
    if (type != GP_EVENT_FILE_ADDED) return {};
    const auto* path = static_cast<const CameraFilePath*>(data);
    return CardPath{path->folder, path->name};
  }
};

GphotoSession::GphotoSession(const std::string& model, const std::string& port)
    : library_(std::make_unique<Library>()) {
  const LogKeeper keeper;
  checked(gp_camera_new(&library_->camera), "a new camera");
  if (!model.empty()) library_->choose_model(model);
  library_->choose_port(port);
  checked(gp_camera_init(library_->camera, library_->context), "connecting to '" + model + "' at '" + port + "'");
}

GphotoSession::~GphotoSession() { gp_camera_exit(library_->camera, library_->context); }

void GphotoSession::set(const std::string& name, const std::string& value) {
  const LogKeeper keeper;
  const auto [widget, type] = library_->setting(name);
  const std::string what = "setting '" + name + "' to '" + value + "'";
  if (type == GP_WIDGET_TOGGLE) {
    const int on = value == "1" || value == "on" ? 1 : 0;
    checked(gp_widget_set_value(widget.get(), &on), what);
  } else if (type == GP_WIDGET_RANGE) {
    const float number = std::strtof(value.c_str(), nullptr);
    checked(gp_widget_set_value(widget.get(), &number), what);
  } else {
    checked(gp_widget_set_value(widget.get(), value.c_str()), what);
  }
  checked(gp_camera_set_single_config(library_->camera, name.c_str(), widget.get(), library_->context), what);
}

std::string GphotoSession::get(const std::string& name) {
  const LogKeeper keeper;
  const auto [widget, type] = library_->setting(name);
  if (type == GP_WIDGET_TOGGLE) {
    int on = 0;
    checked(gp_widget_get_value(widget.get(), &on), "reading '" + name + "'");
    return std::to_string(on);
  }
  if (type == GP_WIDGET_RANGE) {
    float number = 0;
    checked(gp_widget_get_value(widget.get(), &number), "reading '" + name + "'");
    return std::to_string(number);
  }
  const char* text = nullptr;
  checked(gp_widget_get_value(widget.get(), &text), "reading '" + name + "'");
  return text == nullptr ? "" : text;
}

std::vector<std::string> GphotoSession::choices(const std::string& name) {
  const LogKeeper keeper;
  const auto [widget, type] = library_->setting(name);
  std::vector<std::string> choices;
  const int count = type == GP_WIDGET_RADIO || type == GP_WIDGET_MENU ? gp_widget_count_choices(widget.get()) : 0;
  for (int i = 0; i < count; ++i) {
    const char* text = nullptr;
    checked(gp_widget_get_choice(widget.get(), i, &text), "choices of '" + name + "'");
    choices.emplace_back(text);
  }
  return choices;
}

CardPath GphotoSession::capture(double timeout_s) {
  const LogKeeper keeper;
  CameraEventType type = GP_EVENT_UNKNOWN;
  for (int left = 100; left > 0 && type != GP_EVENT_TIMEOUT; --left) library_->next_file(1, type);
  const double deadline_s = library_->clock.now_s() + timeout_s;
  library_->release_shutter(deadline_s);
  while (library_->clock.now_s() < deadline_s) {
    const std::optional<CardPath> path = library_->next_file(100, type);
    if (path && !is_jpeg(path->file)) return *path;
    if (path) remove(*path);
  }
  throw Timeout("releasing the shutter: no picture reported within " + std::to_string(timeout_s) + " s");
}

std::vector<std::uint8_t> GphotoSession::download(const CardPath& path) {
  last_log.clear();
  const std::string what = "downloading " + path.folder + "/" + path.file;
  CameraFile* made = nullptr;
  checked(gp_file_new(&made), what);
  const OwnedFile file(made);
  checked(gp_camera_file_get(library_->camera, path.folder.c_str(), path.file.c_str(), GP_FILE_TYPE_NORMAL, made,
                             library_->context),
          what);
  const char* data = nullptr;
  unsigned long size = 0;
  checked(gp_file_get_data_and_size(made, &data, &size), what);
  return {data, data + size};
}

void GphotoSession::remove(const CardPath& path) {
  const LogKeeper keeper;
  checked(gp_camera_file_delete(library_->camera, path.folder.c_str(), path.file.c_str(), library_->context),
          "deleting " + path.folder + "/" + path.file);
}

}  // namespace lumitexel
