#include "processing/report/model_report.h"

#include <nlohmann/json.hpp>

#include "processing/model/render_view.h"
#include "processing/report/html.h"
#include "processing/report/page_style.h"
#include "processing/report/report_sections.h"

namespace lumitexel {

std::string model_report(const ReportSubject& subject, Progress& progress) {
  using Json = nlohmann::json;
  const Json provenance = Json::parse(subject.model.provenance_json);
  const ViewRenderer renderer(subject.model);
  const bool compared = subject.session != nullptr && subject.evaluation != nullptr;

  std::string body = headline(subject, provenance);
  if (compared) {
    body += comparison_section(subject, renderer, progress);
  } else {
    body += html::section("Photographs",
                          "This page was made without the session's photographs: run the report with "
                          "--session to see them beside their re-renderings.",
                          "");
  }
  body += sample_error_section(provenance);
  if (compared) body += photograph_error_section(*subject.evaluation);
  body += material_section(subject, renderer);
  body += outlier_section(provenance);
  if (subject.session != nullptr) body += setup_section(*subject.session);
  body += timing_section(provenance) + definitions_section();

  const Json data = {{"evaluation", compared ? Json::parse(evaluation_json(*subject.evaluation)) : Json(nullptr)},
                     {"provenance", provenance},
                     {"texels_by_material", texels_by_material(subject.model)}};
  return html::page(subject.name + " – Lumitexel report", kPageStyle, body, data.dump(1));
}

}  // namespace lumitexel
