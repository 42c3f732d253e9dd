#include "sim/protocol/modbus/pseudo_terminal.h"

#include <fcntl.h>
#include <pty.h>
#include <stdlib.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "drivers/error.h"

namespace lumitexel {
namespace {

std::filesystem::path new_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "lumitexel-serial-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw Error(pattern + ": no temporary folder could be made: " + std::strerror(errno));
  return pattern;
}

}  // namespace

PseudoTerminal::PseudoTerminal(std::filesystem::path link) : link_(std::move(link)) {
  if (link_.empty()) {
    own_folder_ = new_folder();
    link_ = own_folder_ / "port";
  }
  plug_in();
}

PseudoTerminal::~PseudoTerminal() {
  unplug();
  std::error_code ignored;
  if (!own_folder_.empty()) std::filesystem::remove(own_folder_, ignored);
}

void PseudoTerminal::unplug() {
  std::error_code ignored;
  if (std::filesystem::is_symlink(link_, ignored)) std::filesystem::remove(link_, ignored);
  slave_.reset();
  master_.reset();
}

void PseudoTerminal::plug_in() {
  termios raw{};
  cfmakeraw(&raw);
  int master = -1, slave = -1;
  std::array<char, 128> name{};
  if (openpty(&master, &slave, name.data(), &raw, nullptr) != 0) {
    throw Error("pseudo-terminal for " + link_.string() + ": cannot be opened: " + std::strerror(errno));
  }
  master_ = FileDescriptor(master);
  slave_ = FileDescriptor(slave);
  fcntl(master, F_SETFL, O_NONBLOCK);
  fcntl(master, F_SETFD, FD_CLOEXEC);
  fcntl(slave, F_SETFD, FD_CLOEXEC);
  std::error_code error;
  if (std::filesystem::is_symlink(link_, error)) std::filesystem::remove(link_, error);
  std::filesystem::create_symlink(name.data(), link_, error);
  if (error) throw Error(link_.string() + ": cannot be made to point to a serial port: " + error.message());
}

}  // namespace lumitexel
