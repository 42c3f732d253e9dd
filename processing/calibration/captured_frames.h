// The frames of a captured session by what they are for.
#pragma once

#include <string>
#include <vector>

#include "drivers/camera.h"
#include "processing/image/dark_frames.h"
#include "rig/session_store.h"

namespace lumitexel {

class CapturedFrames {
 public:
  // Keeps a reference to the session. Throws BadInput naming it if shots are missing: only a whole session is
  // calibrated.
  explicit CapturedFrames(const SessionStore& session);

  // The frames of a kind (and view; "" for gray card and darks), in the order of their indices. Throws BadInput if
  // there are none.
  std::vector<FrameRecord> of(ShotKind kind, const std::string& view = "") const;
  std::int64_t begun_utc_ns() const;  // when the first frame arrived
  bool has(ShotKind kind) const;
  // The shots' indices (Shot::index), in the order of of(kind).
  std::vector<int> indices_of(ShotKind kind) const;
  // Pixels and reported settings. Throws Corrupt if the file is not what was committed.
  Frame load(const FrameRecord& record) const;
  std::vector<Frame> load(const std::vector<FrameRecord>& records) const;
  // Master darks of every exposure that was darkened.
  DarkLibrary master_darks(const LinearSensor& sensor) const;

 private:
  struct Taken {
    Shot shot;
    FrameRecord record;
  };
  const SessionStore& session_;
  std::vector<Taken> taken_;
};

}  // namespace lumitexel
