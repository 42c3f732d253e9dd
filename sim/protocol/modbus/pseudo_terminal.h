// A serial port without hardware: a pseudo-terminal under a name of our choice, as udev gives a USB adapter a lasting
// one.
#pragma once

#include <filesystem>
#include <string>

#include "sim/protocol/modbus/file_descriptor.h"

namespace lumitexel {

class PseudoTerminal {
 public:
  // link: where the port shall be found, a symbolic link that is made and removed again; replaced if it is a link
  // already. Empty: a new one in the folder for temporary files. Plugged in from the start. Throws Error.
  explicit PseudoTerminal(std::filesystem::path link);
  ~PseudoTerminal();

  const std::filesystem::path& path() const { return link_; }
  int master_fd() const { return master_.get(); }  // -1 while unplugged

  // Clients that have it open lose it. Plugged in again, it is another device under the same name.
  void unplug();
  void plug_in();  // throws Error

 private:
  std::filesystem::path link_, own_folder_;
  FileDescriptor master_;
  FileDescriptor slave_;  // kept open: without any, reading from the master would fail between two clients
};

}  // namespace lumitexel
