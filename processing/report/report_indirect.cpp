#include <nlohmann/json.hpp>

#include "processing/report/html.h"
#include "processing/report/report_sections.h"
#include "processing/report/texel_maps.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr int kBound = 0, kFound = 1;                 // channels of Model::indirect
constexpr double kFullBound = 0.5, kFullFound = 0.3;  // drawn in full colour

std::string picture(const ReportSubject& subject, int channel, double full, const View& view, const std::string& what, const std::string& caption) {
  const Model form = carrying(subject.model, subject.model.indirect, channel);
  const ViewRenderer renderer(form);
  const Image values = renderer.render_aov(view, Aov::Sigma);
  const Image shown = drawn(renderer.render_aov(view, Aov::Normal), [&](int x, int y) { return values.at(x, y) / full; });
  return figure_with_scale(shown, what, caption, "0 %", percent(Json(full)) + " and more");
}

std::string introduction(const Json& data) {
  const std::string what = "Surfaces that face each other light each other. A fit that knows the lamp alone takes that light for brighter or more colourful "
                           "material. ";
  if (data.at("bounces") == 0) {
    return what + "Here it cannot matter, was too little to change anything, or the photographs do not show it: nothing was taken out of them.";
  }
  return what + "Where it can matter, it was computed from the model itself (" + std::to_string(data.at("bounces").get<int>()) +
         " bounces), taken out of the photographs, and the materials fitted anew.";
}

}  // namespace

Json indirect_json(const Model& model) {
  if (model.indirect.data.empty()) return nullptr;
  const std::vector<float> bounds = values_where_measured(model, model.indirect, kBound), found = values_where_measured(model, model.indirect, kFound);
  return {{"bounces", model.indirect_bounces}, {"estimated_most", spread_of(bounds)}, {"found_share", spread_of(found)}};
}

std::string indirect_section(const ReportSubject& subject, const Json& data, const View& view) {
  if (!data.is_object()) return "";
  const Json &bound = data.at("estimated_most"), &found = data.at("found_share");
  std::string body = picture(subject, kBound, kFullBound, view, "most that light between surfaces could be",
                             "The most that it could be beside a lamp's light, estimated from what each point faces and how bright that is: half of the measured "
                             "texels at most " + percent(bound.at("median")) + ", nine tenths at most " + percent(bound.at("nine_tenths")) + ".");
  if (data.at("bounces") != 0) {
    body += picture(subject, kFound, kFullFound, view, "light between surfaces, as found",
                    "What was found and taken out, as a share of what the photographs show there: half of the measured texels at most " +
                        percent(found.at("median")) + ", nine tenths at most " + percent(found.at("nine_tenths")) + ".");
  }
  return html::section("Light between surfaces", introduction(data), "<div class=\"row two\">" + body + "</div>\n");
}

}  // namespace lumitexel
