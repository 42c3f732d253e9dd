// views.json: a calibrated session's views beside their photographs, so that a second run only reads.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"

namespace lumitexel {

// Writes DIRECTORY/views.json under a temporary name and renames it: it exists only once everything beside it is whole.
// The mesh is not in it. Throws Error.
void write_calibrated_views(const std::filesystem::path& directory, const CalibratedSession& session,
                            const CalibrationSummary& summary);

// None if there is no whole views.json of this version or a photograph is missing: then everything is made again.
// `mesh` stays empty.
std::optional<std::pair<CalibratedSession, CalibrationSummary>> read_calibrated_views(
    const std::filesystem::path& directory);

}  // namespace lumitexel
