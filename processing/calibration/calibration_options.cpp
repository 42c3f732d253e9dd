#include "processing/calibration/calibration_options.h"

#include "drivers/error.h"

namespace lumitexel {

const std::vector<CalibrationStep>& all_calibration_steps() {
  static const std::vector<CalibrationStep> all{
      CalibrationStep::PhotonTransfer, CalibrationStep::Response, CalibrationStep::DarkScale,
      CalibrationStep::Lens,           CalibrationStep::Vignetting, CalibrationStep::Pose,
      CalibrationStep::Joint,          CalibrationStep::CardPose,   CalibrationStep::LampDrift,
      CalibrationStep::LampPattern};
  return all;
}

const char* to_string(CalibrationStep step) {
  switch (step) {
    case CalibrationStep::PhotonTransfer: return "photon_transfer";
    case CalibrationStep::Response: return "response";
    case CalibrationStep::DarkScale: return "dark_scale";
    case CalibrationStep::Lens: return "lens";
    case CalibrationStep::Vignetting: return "vignetting";
    case CalibrationStep::Pose: return "pose";
    case CalibrationStep::Joint: return "joint";
    case CalibrationStep::CardPose: return "card_pose";
    case CalibrationStep::LampDrift: return "lamp_drift";
    case CalibrationStep::LampPattern: return "lamp_pattern";
  }
  return "";
}

CalibrationStep calibration_step_from_string(const std::string& name) {
  std::string known;
  for (const CalibrationStep step : all_calibration_steps()) {
    if (name == to_string(step)) return step;
    known += (known.empty() ? "" : ", ") + std::string(to_string(step));
  }
  throw BadInput("calibration step", name, "one of " + known);
}

std::string CalibrationOptions::key() const {
  std::string text;
  for (const CalibrationStep step : without) text += std::string(" without ") + to_string(step);
  return text;
}

}  // namespace lumitexel
