#include <algorithm>
#include <nlohmann/json.hpp>

#include "processing/report/html.h"
#include "processing/report/report_sections.h"
#include "processing/report/texel_maps.h"
#include "processing/report/view_pictures.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr double kFullSigma = 0.5;  // drawn in full colour: half of the reflectance itself is open

std::string count(const Json& value) { return value.is_number() ? html::number(value.get<double>()) : "–"; }

}  // namespace

Json coverage_json(const Model& model) {
  const std::vector<float> samples = values_where_measured(model, model.samples);
  const std::vector<float> sigma = values_where_measured(model, model.uncertainty);
  const auto surface = std::count_if(model.material.begin(), model.material.end(), [](std::int16_t m) { return m != Model::kNoMaterial; });
  return {{"texels", surface},
          {"texels_measured", samples.size()},
          {"samples_a_texel", {{"tenth", share_below(samples, 0.1)}, {"median", share_below(samples, 0.5)}, {"most", share_below(samples, 1.0)}}},
          {"relative_sigma", {{"median", share_below(sigma, 0.5)}, {"nine_tenths", share_below(sigma, 0.9)}}}};
}

std::string coverage_section(const Json& data, const ViewRenderer& renderer, const View& view) {
  const Json& samples = data.at("samples_a_texel");
  const Json& sigma = data.at("relative_sigma");
  const Image normal = renderer.render_aov(view, Aov::Normal), seen = renderer.render_aov(view, Aov::Samples), open = renderer.render_aov(view, Aov::Sigma);
  const double most = samples.at("most").is_number() ? samples.at("most").get<double>() : 1.0;
  const std::string views =
      html::figure(html::picture(drawn(normal, [&](int x, int y) { return seen.at(x, y) / most - 1.0; }), "samples a texel"),
                   "How many photographs measured each point. Half of the texels have " + count(samples.at("median")) +
                       " or more, nine tenths " + count(samples.at("tenth")) + " or more.") +
      html::colour_scale(false_colour(-1.0), false_colour(0.0), "no photograph", count(samples.at("most")) + " photographs");
  const std::string uncertain =
      figure_with_scale(drawn(normal, [&](int x, int y) { return open.at(x, y) / kFullSigma; }), "uncertainty",
                   "How uncertain the reflectance is, one sigma of its value. Half of the texels are within " + percent(sigma.at("median")) +
                       ", nine tenths within " + percent(sigma.at("nine_tenths")) + ".",
                        "0 %", percent(Json(kFullSigma)) + " and more");
  return html::section("Where it was measured, and how surely",
                       "Points that few photographs saw lit are less certain. Blue on the left and red on the right is where more "
                       "photographs would help most; what was never measured borrows from its neighbours and is blue and red. Thin lines are edges of the "
                       "atlas's patches, where a texel borrows, too.",
                       "<div class=\"row two\"><div>" + views + "</div>" + uncertain + "</div>\n");
}

}  // namespace lumitexel
