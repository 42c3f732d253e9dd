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
          {"pictures", compared ? shown_json(subject, ViewRenderer(subject.model)) : Json::array()},
          {"provenance", provenance},
          {"texels_by_material", texels_by_material(subject.model)},
          {"materials", materials_json(subject.model)},
          {"coverage", coverage_json(subject.model)},
          {"uncertainty_from", doubt_json(subject)},
          {"normals", normals_json(subject.model)},
          {"light_between_surfaces", indirect_json(subject.model)},
          {"setup", subject.session != nullptr ? setup_json(*subject.session) : Json(nullptr)},
          {"exposures", exposures_json(subject.exposures)},
          {"calibration", subject.calibration != nullptr ? summary_json(*subject.calibration) : Json(nullptr)},
          {"nearest_materials", nearest_json(subject)},
          {"known_materials", subject.known.size()}};
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
    body += typical_comparison(subject, data.at("evaluation"), renderer);
    body += comparison_section(subject, data.at("pictures"), data.at("evaluation"), renderer, progress);
  } else {
    body += html::section("Photographs",
                          "This page was made without the session's photographs: run the report with "
                          "--session to see them beside their re-renderings.",
                          "");
  }
  body += subject.viewer;
  body += stage_section(data.at("stages"), provenance);
  if (compared) body += photograph_error_section(data.at("evaluation"));
  body += material_section(subject, data.at("materials"), renderer);
  body += nearest_section(subject, data.at("nearest_materials"), data.at("known_materials"));
  body += normals_section(subject, data.at("normals"), renderer, view);
  body += indirect_section(subject, data.at("light_between_surfaces"), view);
  body += coverage_section(data.at("coverage"), renderer, view);
  body += doubt_section(subject, data.at("uncertainty_from"), view);
  body += choice_section(provenance);
  body += outlier_section(provenance);
  if (subject.session != nullptr) body += setup_section(*subject.session);
  body += exposure_section(subject.exposures, data.at("exposures"));
  if (subject.calibration != nullptr) body += calibration_section(data.at("calibration"));
  body += timing_section(provenance) + definitions_section();
  return html::page(subject.name + " – Lumitexel report", kPageStyle, body, data_json);
}

}  // namespace lumitexel
