#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_views.h"
#include "processing/calibration/import/imported_views.h"

namespace lumitexel {

CalibratedSession calibrate_session(const SessionStore& session, Progress& progress, CalibrationSummary* summary,
                                    const CalibrationOptions& options) {
  if (session.kind() == SessionKind::Imported) {
    CalibratedSession calibrated = calibrate_imported(session, progress);
    if (summary) {
      *summary = {};
      for (const View& view : calibrated.views) {
        LightSummary& light = summary->lights.emplace_back();
        light.view = view.name;
        light.position_in_world = view.light.vector_in_world;
        light.sigma_m = view.light.sigma_m;
      }
    }
    return calibrated;
  }
  auto [calibrated, measured] = calibrate_captured(session, progress, options);
  if (summary) *summary = std::move(measured);
  return calibrated;
}

}  // namespace lumitexel
