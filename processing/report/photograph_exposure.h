// How the photographs were exposed, and how bright the object is in them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "rig/progress.h"
#include "rig/session_store.h"

namespace lumitexel {

// Of the object's radiance, nearest rank.
inline constexpr std::array<double, 5> kRadianceShares{0.01, 0.25, 0.5, 0.75, 0.99};

struct PhotographExposure {
  std::string view;
  bool heldout = false;
  std::vector<double> exposure_s;  // of the bracket's frames, as the camera reported them, ascending; empty of an imported photograph
  // Of the pixels of the object's mask (of all, where the session has no masks): clipped even in the shortest exposure; below the noise
  // even in the longest, which only brackets tell.
  double clipped_share = 0, dark_share = 0;
  std::array<double, 5> radiance{};  // at kRadianceShares, mean over channels, over those pixels that are usable; 0 where there are none
};

// Reads the photographs one at a time, in the session's order. Throws Corrupt if one cannot be read.
std::vector<PhotographExposure> photograph_exposures(const SessionStore& store, const CalibratedSession& session, Progress& progress);
PhotographExposure exposure_of(const RadianceImage& photograph);  // without view and bracket

}  // namespace lumitexel
