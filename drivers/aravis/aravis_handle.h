// Ownership of the library's objects, and its errors as ours. Only for the .cpp files of this folder.
#pragma once

#include <arv.h>

#include <memory>
#include <string>

namespace lumitexel {

struct GObjectUnref {
  void operator()(void* object) const { g_object_unref(object); }
};
template <class T>
using GHandle = std::unique_ptr<T, GObjectUnref>;

struct GFree {
  void operator()(void* memory) const { g_free(memory); }
};

// Where a call of the library puts its error. Pass to one call, then ask require().
class GErrorSlot {
 public:
  GErrorSlot() = default;
  ~GErrorSlot() { g_clear_error(&error_); }
  GErrorSlot(const GErrorSlot&) = delete;
  GErrorSlot& operator=(const GErrorSlot&) = delete;

  operator GError**() { return &error_; }
  bool is_set() const { return error_ != nullptr; }
  // Throws by cause if there is an error: Timeout, Disconnected (control or the device is gone), OutOfRange, Protocol.
  // camera: its name; asked: what was asked of it.
  void require(const std::string& camera, const std::string& asked) const;

 private:
  GError* error_ = nullptr;
};

}  // namespace lumitexel
