// A simulated session's calibration against what the simulation knows to be true.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"

namespace lumitexel {

struct TruthComparison {
  std::string text;     // lines for people
  std::string json;     // an object: light_error_mm, light_error_spheres_alone_mm, pose_error, intensity_error, lens_error_px
};

// None without SESSION/truth/calibration.json. Throws Corrupt naming it if it is not readable.
std::optional<TruthComparison> compare_with_truth(const std::filesystem::path& session_directory,
                                                  const CalibratedSession& session, const CalibrationSummary& summary);

}  // namespace lumitexel
