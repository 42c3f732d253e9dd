#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_views.h"
#include "processing/calibration/import/imported_views.h"

namespace lumitexel {

CalibratedSession calibrate_session(const SessionStore& session, Progress& progress, CalibrationSummary* summary,
                                    const CalibrationOptions& options) {
  auto [calibrated, measured] = session.kind() == SessionKind::Imported ? calibrate_imported(session, progress, options)
                                                                        : calibrate_captured(session, progress, options);
  if (summary) *summary = std::move(measured);
  return calibrated;
}

}  // namespace lumitexel
