// A session whose photographs to fit have larger pixels: what a cheaper camera would have given.
#pragma once

#include <filesystem>
#include <memory>

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

class CoarserSession {
 public:
  // Fit views' photographs binned by `block` (binned_radiance.h) and written to a temporary folder, which goes with this; their cameras
  // follow. Held-out views stay as they are. block 1: the session itself, nothing written. Throws Error if it cannot be written.
  CoarserSession(const CalibratedSession& session, int block);

  const CalibratedSession& session() const { return session_; }

 private:
  CalibratedSession session_;
  std::shared_ptr<const std::filesystem::path> folder_;  // removed with the last owner
};

}  // namespace lumitexel
