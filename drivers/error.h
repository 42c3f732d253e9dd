// Errors by cause. Device and I/O faults throw one of these; what merely depends on the data
// (a fit that does not converge, a texel without samples) is returned in a summary instead.
//
// Every message names the device or file, what was asked of it and what came back.
#pragma once

#include <stdexcept>
#include <string>

namespace lumitexel {

// The base of every fault in this project; catch it to report a failed run (exit code 1).
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Timeout : public Error { public: using Error::Error; };       // no answer within the deadline
class Disconnected : public Error { public: using Error::Error; };  // the device is gone
class OutOfRange : public Error { public: using Error::Error; };    // asked for more than the device can do
class Protocol : public Error { public: using Error::Error; };      // an answer that breaks the protocol
class StorageFull : public Error { public: using Error::Error; };   // no room left for the data
class Corrupt : public Error { public: using Error::Error; };       // stored bytes are not what was stored (exit code 2)
class Cancelled : public Error { public: using Error::Error; };     // the caller's stop token was set

// Input from the user that cannot be used (exit code 2). Thrown before anything moves or is written.
class BadInput : public Error {
 public:
  // where: the file and line, key or field; what: the value found; expected: what would be right.
  BadInput(const std::string& where, const std::string& what, const std::string& expected)
      : Error(where + ": " + what + "; expected " + expected) {}
};

}  // namespace lumitexel
