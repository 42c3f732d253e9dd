// Which steps of a calibration are taken: all, unless one wants to see what a step is worth.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace lumitexel {

enum class CalibrationStep {
  PhotonTransfer,  // noise figures from the session's own frames; else the rig's description
  Response,        // a curve for a sensor that is not linear; else linear
  DarkScale,       // darks scaled where the sensor has warmed; else subtracted as they are
  Lens,            // from board shots or a lens calibration; else the rig's description
  Vignetting,      // from flat fields; else none
  Pose,            // from silhouettes and tags; else the rig's geometry
  Joint,           // lens and poses once more, with the highlights; else lights are solved with the lens as it is
  CardPose,        // from the tags on the card's frame; else the rig's description
  LampDrift,       // from the card in every view; else a lamp that never changes
  LampPattern,     // from the board under the point light; else equal in all directions
};

struct CalibrationOptions {
  std::set<CalibrationStep> without{};

  bool takes(CalibrationStep step) const { return !without.contains(step); }
  // Part of a calibration's key: "" for all steps.
  std::string key() const;
};

const std::vector<CalibrationStep>& all_calibration_steps();
const char* to_string(CalibrationStep step);  // "photon_transfer", "response", …
// Throws BadInput on any other name.
CalibrationStep calibration_step_from_string(const std::string& name);

}  // namespace lumitexel
