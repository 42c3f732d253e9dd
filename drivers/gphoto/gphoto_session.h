// libgphoto2, in the worker process: one camera, blocking calls without deadlines of their own. Whoever uses it must be
// able to die in the middle of any of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lumitexel {

struct CardPath {
  std::string folder, file;
};

class GphotoSession {
 public:
  // Connects. model: libgphoto2's name, empty: the one that it detects at the port (USB only). Every member throws
  // Timeout, Disconnected, Protocol or OutOfRange (no such model, port, setting or choice) naming what libgphoto2 said.
  GphotoSession(const std::string& model, const std::string& port);
  ~GphotoSession();

  // By the text of a choice, or free text for settings without choices.
  void set(const std::string& name, const std::string& value);
  std::string get(const std::string& name);
  std::vector<std::string> choices(const std::string& name);

  // Releases the shutter and waits until the camera reports the new file. What it reported before is passed over: it is
  // of a picture that nobody waits for any more. JPEG files, which cameras set to two formats write beside the raw one,
  // are deleted and passed over. Throws also StorageFull.
  CardPath capture(double timeout_s);
  std::vector<std::uint8_t> download(const CardPath& path);
  void remove(const CardPath& path);

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace lumitexel
