// A session of the small rig, captured from fake devices that can be told to misbehave, for tests to play back.
#pragma once

#include <functional>
#include <memory>
#include <set>

#include "rig/session_store.h"
#include "tests/unit/fake_rig.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

// Stands in for the fake bench's hooks: called with the number of the trigger, from 1, of this run.
struct Misbehaviour {
  std::function<void(int trigger)> before_exposure;              // may throw
  std::function<void(int trigger, Frame& frame)> tamper;
};

class RecordedSession {
 public:
  // One run of a capture, the first or a later one; a fault that ends it is swallowed.
  void capture(const Misbehaviour& misbehaviour = {});
  std::shared_ptr<const SessionStore> open() const;
  std::filesystem::path path() const { return folder_ / "recorded"; }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;
};

// Everything that a journal says of frames and discards, one line each; the bytes of the frames' files by their hash.
std::vector<std::string> frame_lines(const SessionStore& session);
std::vector<std::string> discard_lines(const SessionStore& session);

}  // namespace lumitexel
