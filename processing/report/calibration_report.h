// A session's calibration as one offline page: what was measured, how well, by what, and what to look at.
#pragma once

#include <filesystem>
#include <string>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"

namespace lumitexel {

// pictures: the folder that holds summary.pictures. truth_text: lines about a simulated session's truth; may be empty.
// data_json goes into the page's data block.
std::string calibration_report(const CalibratedSession& session, const CalibrationSummary& summary,
                               const std::filesystem::path& pictures, const std::string& truth_text,
                               const std::string& data_json);

// Its section about views, as other pages show it: of a captured session, and of an imported one whose poses were given and held against
// the masks.
std::string calibrated_views_section(const CalibrationSummary& summary);
std::string given_poses_section(const CalibrationSummary& summary);

}  // namespace lumitexel
