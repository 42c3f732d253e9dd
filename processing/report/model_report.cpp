#include "processing/report/model_report.h"

#include <nlohmann/json.hpp>

#include "processing/calibration/calibration_summary_json.h"
#include "processing/model/render_view.h"
#include "processing/report/html.h"
#include "processing/report/page_style.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

Json page_data(const ReportSubject& subject) {
  const bool compared = subject.session != nullptr && subject.evaluation != nullptr;
  const Json provenance = Json::parse(subject.model.provenance_json);
  return {{"summary", summary_json(subject)},
          {"stages", stages_json(provenance, compared ? subject.evaluation : nullptr)},
          {"evaluation", compared ? Json::parse(evaluation_json(*subject.evaluation)) : Json(nullptr)},
          {"provenance", provenance},
          {"texels_by_material", texels_by_material(subject.model)},
          {"coverage", coverage_json(subject.model)},
          {"uncertainty_from", doubt_json(subject)},
          {"normals", normals_json(subject.model)},
          {"light_between_surfaces", indirect_json(subject.model)},
          {"exposures", exposures_json(subject.exposures)},
          {"calibration", subject.calibration != nullptr ? summary_json(*subject.calibration) : Json(nullptr)},
          {"nearest_materials", nearest_json(subject)}};
}

}  // namespace

std::string report_json(const ReportSubject& subject) { return page_data(subject).dump(1); }

std::string model_report(const ReportSubject& subject, const std::string& data_json, Progress& progress) {
  const Json data = Json::parse(data_json);
  const Json& provenance = data.at("provenance");
  const ViewRenderer renderer(subject.model);
  const View view = map_view(subject);
  const bool compared = subject.session != nullptr && subject.evaluation != nullptr;

  std::string body = headline(subject, data.at("summary"));
  if (compared) {
    body += typical_comparison(subject, renderer);
    body += comparison_section(subject, renderer, progress);
  } else {
    body += html::section("Photographs",
                          "This page was made without the session's photographs: run the report with "
                          "--session to see them beside their re-renderings.",
                          "");
  }
  body += subject.viewer;
  body += stage_section(data.at("stages"), provenance);
  if (compared) body += photograph_error_section(*subject.evaluation);
  body += material_section(subject, renderer);
  body += nearest_section(subject);
  body += normals_section(subject, data.at("normals"), renderer, view);
  body += indirect_section(subject, data.at("light_between_surfaces"), view);
  body += coverage_section(subject.model, renderer, view);
  body += doubt_section(subject, data.at("uncertainty_from"), view);
  body += choice_section(provenance);
  body += outlier_section(provenance);
  if (subject.session != nullptr) body += setup_section(*subject.session);
  body += exposure_section(subject.exposures);
  if (subject.calibration != nullptr) body += calibration_section(*subject.calibration);
  body += timing_section(provenance) + definitions_section();
  return html::page(subject.name + " – Lumitexel report", kPageStyle, body, data_json);
}

}  // namespace lumitexel
