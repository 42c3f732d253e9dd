// The point light's intensity in every view of a captured session: absolute, over time and direction.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/light/lamp_pattern.h"
#include "processing/calibration/session_card.h"
#include "processing/calibration/session_lens.h"
#include "processing/calibration/session_lights.h"
#include "processing/calibration/session_strays.h"

namespace lumitexel {

// A card reading with what it was taken under.
struct TimedReading {
  double time_s = 0;  // since the session's first frame
  Eigen::Vector3d light_in_rig = Eigen::Vector3d::Zero();
  std::optional<CardReading> reading;
  std::vector<double> stray_shares{};  // of the card's light, per channel (SessionStrays); empty: none
};

struct SessionLamp {
  LampPattern pattern;
  std::vector<std::vector<double>> intensity;  // by view and channel, along the lamp's z
  std::vector<Eigen::Matrix3d> lamp_from_rig;  // by view: the turn
  double scale_sigma = 0;                      // relative
};

// The pattern from the board under the point light, if the session has such shots and the board's pose is known.
// Directions count from the arm's pivot as `lights` has aligned it. Strays on the board stay in it; what the pattern would be
// without them is that far off its covariance's mean: the covariance holds the difference.
LampPattern measure_lamp_pattern(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                                 const SessionLens& lens, const SessionLights& lights, const SessionStrays& strays,
                                 const CalibrationOptions& options, CalibrationSummary& summary);

// views: one entry a view, possibly without a reading; card: the gray card's own bracket, with one. Fills in summary.lamp,
// intensity, gray_card_pixel_scatter, scale_sigma and the scale's shares. Strays stay in the readings; what intensity and factors
// would be without them is that far off is in their sigmas.
SessionLamp measure_lamp(const CapturedInputs& in, const SessionLights& lights, const LampPattern& pattern,
                         const std::vector<TimedReading>& views, const TimedReading& card,
                         const CalibrationOptions& options, CalibrationSummary& summary);

}  // namespace lumitexel
