// What a fit found, as one page for people: a single HTML file that needs nothing else, not even a network.
#pragma once

#include <span>
#include <string>

#include "processing/brdf/nearest_material.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/model/model.h"
#include "processing/report/photograph_exposure.h"
#include "rig/progress.h"

namespace lumitexel {

struct ReportSubject {
  std::string name;  // what the page is titled with, e.g. the model's folder
  const Model& model;
  // The photographs to compare with, and what the comparison found; without them the page says what is left out.
  const CalibratedSession* session = nullptr;
  const Evaluation* evaluation = nullptr;
  const CalibrationSummary* calibration = nullptr;  // what calibration says of poses and lights
  std::vector<PhotographExposure> exposures{};      // of the session's photographs; the page says nothing of exposures without them
  std::span<const KnownMaterial> known{};  // measured materials to name the nearest of
  std::string known_source{};               // where they are from, "the … database"
  std::string viewer{};                    // a section with the interactive view (viewer/viewer_section.h); empty: none
};

// Every number of the page, as JSON: {"summary": the sentences on top,
// "stages": the fit's, "evaluation": as `lumitexel evaluate --json` or null, "pictures": what white is in them, "provenance": the fit's, "texels_by_material": [texels that were fitted to
// samples], "materials": what each reflects, "coverage": of the texels and their sigma, "uncertainty_from": shares by cause or null, "normals": tilts and sigmas or null, "setup": where cameras and lights stood or null, "exposures": a photograph each, "calibration": as `lumitexel calibrate --json` has it or null, "nearest_materials": [three for each material], "known_materials": of how many}.
std::string report_json(const ReportSubject& subject);
// The page. data_json: report_json of the same subject, which also goes into its <script type="application/json" id="data">.
std::string model_report(const ReportSubject& subject, const std::string& data_json, Progress& progress);

}  // namespace lumitexel
