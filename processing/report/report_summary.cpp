#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "processing/evaluation/stage_caution.h"
#include "processing/report/html.h"
#include "processing/report/measured_area.h"
#include "processing/report/report_sections.h"
#include "processing/report/texel_maps.h"
#include "processing/report/view_pictures.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr int kPictureWidth_px = 540;

// By the error on square roots, which is nearest to how differences look.
struct Verdict {
  double below;
  const char* words;
};
constexpr Verdict kVerdicts[] = {{0.05, "almost exactly"},
                                 {0.1, "closely"},
                                 {0.2, "well, with small differences"},
                                 {0.4, "recognisably, with differences that show"},
                                 {HUGE_VAL, "poorly"}};

std::string in_words(double sqrt_rms) {
  for (const Verdict& verdict : kVerdicts) {
    if (sqrt_rms < verdict.below) return verdict.words;
  }
  return "not at all";  // not a number
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// The one with the median clipped error of its kind, so that neither the best nor the worst is shown. Held-out ones if there are any.
std::optional<std::size_t> typical_view(const Evaluation& evaluation) {
  const bool heldout = std::any_of(evaluation.views.begin(), evaluation.views.end(), [](const ViewEvaluation& v) { return v.heldout; });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < evaluation.views.size(); ++i) {
    const ViewEvaluation& view = evaluation.views[i];
    if (view.heldout == heldout && std::isfinite(view.error.clipped_rms)) order.push_back(i);
  }
  if (order.empty()) return std::nullopt;
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>((order.size() - 1) / 2);
  std::nth_element(order.begin(), middle, order.end(), [&](std::size_t a, std::size_t b) {
    return evaluation.views[a].error.clipped_rms < evaluation.views[b].error.clipped_rms;
  });
  return *middle;
}

Json prediction_json(const Evaluation& evaluation) {
  const std::optional<std::size_t> typical = typical_view(evaluation);
  const bool heldout = typical && evaluation.views[*typical].heldout;
  const auto& error = (heldout ? evaluation.heldout : evaluation.fit)[static_cast<std::size_t>(evaluation.last_stage)];
  if (!typical || !error) return nullptr;
  const auto photographs = std::count_if(evaluation.views.begin(), evaluation.views.end(), [&](const ViewEvaluation& v) { return v.heldout == heldout; });
  return {{"kept_out_of_the_fit", heldout},
          {"photographs", photographs},
          {"square_roots", number_or_null(error->sqrt_rms)},
          {"clipped", number_or_null(error->clipped_rms)},
          {"psnr_db", number_or_null(error->psnr_db)},
          {"in_words", in_words(error->sqrt_rms)},
          {"shown", evaluation.views[*typical].image}};
}

std::string prediction_text(const Json& prediction) {
  const auto number = [&](const char* key) { return percent(prediction.at(key)); };
  const auto count = prediction.at("photographs").get<std::int64_t>();
  const bool heldout = prediction.at("kept_out_of_the_fit").get<bool>();
  const bool one = count == 1;
  const std::string photographs = one ? "One photograph was" : std::to_string(count) + " photographs were", them = one ? "it " : "them ";
  return (heldout ? photographs + " kept out of the measurement as a test, and the model predicts " + them
                  : photographs + " used and none was kept out as a test; the model repeats " + them) +
         prediction.at("in_words").get<std::string>() + ": the difference is " + number("square_roots") + " of the picture as the eye weighs light and dark, and " +
         number("clipped") + " in plain light (highlights capped).";
}

// Never "100 %" where something is missing.
std::string share_text(double share) {
  if (share >= 1.0) return "All";
  return share >= 0.995 ? "Over 99 %" : percent(share);
}

std::string surface_text(const Json& summary) {
  const auto materials = summary.at("materials").get<std::size_t>();
  const double share = summary.at("share_of_surface_measured").get<double>();
  return (materials == 1 ? std::string("One material was") : std::to_string(materials) + " materials were") + " found. " + share_text(share) +
         " of the object's surface was measured" + (share < 1.0 ? "; the rest no photograph shows well enough (in shadow, hidden or from too far aside), and it borrows from what is beside it." : ".");
}

std::string tile(const std::string& value, const std::string& meaning) {
  return "<div class=\"tile\"><b>" + html::escaped(value) + "</b><span>" + html::escaped(meaning) + "</span></div>\n";
}

std::string tiles(const Json& summary) {
  const auto number = [](const Json& parent, const char* key, int digits) { return html::number(number_or_nan(parent, key), digits); };
  std::string text = "<div class=\"tiles\">" + tile(number(summary, "materials", 8), "materials found") +
                     tile(share_text(summary.at("share_of_surface_measured").get<double>()), "of the surface measured") +
                     tile(number(summary, "texels_measured", 10), "surface points (texels) measured") +
                     tile(number(summary, "samples", 10), "reflectance samples the fit used");
  const Json& prediction = summary.at("prediction");
  if (prediction.is_object()) {
    const std::string which = prediction.at("kept_out_of_the_fit").get<bool>() ? "photographs kept out of the fit" : "photographs of the fit";
    text += tile(number(prediction, "clipped", 3), "clipped relative error on " + which);
    text += tile(number(prediction, "psnr_db", 3) + " dB", "PSNR on " + which);
  }
  return text + tile(number(summary, "fit_seconds", 3) + " s", "computing time of the fit") + "</div>";
}

}  // namespace

Json summary_json(const ReportSubject& subject) {
  const Json provenance = Json::parse(subject.model.provenance_json);
  double seconds = 0.0;
  for (const Json& stage : provenance.value("stages", Json::array())) {
    if (stage.contains("seconds") && stage.at("seconds").is_number()) seconds += stage.at("seconds").get<double>();
  }
  const bool compared = subject.session != nullptr && subject.evaluation != nullptr;
  const std::vector<std::int64_t> texels = texels_by_material(subject.model);
  return {{"materials", subject.model.materials.size()},
          {"share_of_surface_measured", measured_area_share(subject.model)},
          {"texels_measured", std::accumulate(texels.begin(), texels.end(), std::int64_t{0})},
          {"samples", provenance.contains("samples") ? provenance.at("samples") : Json(nullptr)},
          {"fit_seconds", seconds},
          {"prediction", compared ? prediction_json(*subject.evaluation) : Json(nullptr)}};
}

std::string headline(const ReportSubject& subject, const Json& summary) {
  std::string text = "<header><h1>" + html::escaped(subject.name) +
                     "</h1>\n<p>How the surface of this object reflects light, measured from photographs under a moving lamp. Each point "
                     "of the surface has a reflectance of its own as far as its photographs ask for one, so the object can be shown from any side under any light.</p>\n<p class=\"finding\">";
  if (summary.at("prediction").is_object()) text += html::escaped(prediction_text(summary.at("prediction"))) + " ";
  text += html::escaped(surface_text(summary)) + "</p>\n";
  const std::string caution = subject.evaluation != nullptr ? in_words(stage_cautions(*subject.evaluation), subject.evaluation->last_stage) : "";
  if (!caution.empty()) text += "<p class=\"caution\">Caution: " + html::escaped(caution) + ".</p>\n";
  return text + tiles(summary) + "</header>\n";
}

std::string typical_comparison(const ReportSubject& subject, const Json& evaluation, const ViewRenderer& renderer) {
  const std::optional<std::size_t> typical = typical_view(*subject.evaluation);
  if (!typical) return "";
  const View& view = subject.session->views[*typical];
  const ViewPictures pictures = make_view_pictures(renderer, view, subject.model.channels, subject.evaluation->last_stage, kPictureWidth_px);
  const bool alone = prediction_json(*subject.evaluation).at("photographs") == 1;
  const std::string kind = view.heldout ? ", kept out of the fit. " : ", used in the fit. ";
  return "<div class=\"row first\">" +
         html::figure(html::picture(pictures.photograph, "photograph " + view.name),
                      "Photograph " + view.name + kind + (alone ? "" : "Of its kind the one with the median error: neither the best nor the worst.")) +
         html::figure(html::picture(pictures.rendering, "rendering of " + view.name),
                      "What the model says it should look like, at the same exposure: clipped relative error " +
                          html::number(number_or_nan(evaluation.at("views").at(*typical), "clipped_rms")) + ".") +
         "</div>\n";
}

}  // namespace lumitexel
