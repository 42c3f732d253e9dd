// The gray card of a captured session: where it stands, and how bright it was under the point light, shot by shot.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/calibration_options.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/lens/tag_detection.h"
#include "processing/calibration/light/arm_alignment.h"
#include "processing/calibration/light/card_pose.h"

namespace lumitexel {

// Apparent intensity of the light: what it would be if it were the same in all directions.
struct CardReading {
  std::vector<double> intensity;      // per channel
  std::vector<double> pixel_scatter;  // per channel, relative
  double pixel_sigma = 0, light_sigma = 0, pose_sigma = 0;  // relative; the last is common to all readings
  Eigen::Vector3d card_in_rig = Eigen::Vector3d::Zero();    // its centre
  Eigen::Vector3d normal_in_rig = Eigen::Vector3d::UnitZ();  // unit, as the card was posed
};

class SessionCard {
 public:
  // The card's pose by the tags on its frame, their corners averaged over all views (the card stands still); without tags,
  // or if the pose is ambiguous, as the rig's description has it.
  SessionCard(const CapturedInputs& in, const CameraModel& camera, const std::vector<std::vector<DetectedTag>>& tags,
              const CalibrationOptions& options);

  bool posed() const { return pose_.has_value(); }
  // Empty if the card faces away from the light or has no usable pixels.
  std::optional<CardReading> read(const MosaicRadiance& picture, const ArmPrediction& light) const;

 private:
  const CapturedInputs& in_;
  const CameraModel& camera_;
  std::optional<CardPose> pose_;
};

}  // namespace lumitexel
