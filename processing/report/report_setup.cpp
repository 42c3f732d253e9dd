#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "processing/calibration/calibration_summary_json.h"
#include "processing/report/calibration_report.h"
#include "processing/report/html.h"
#include "processing/report/plan_drawing.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr double kShownStops = 14.0;  // below the brightest; what is darker is drawn at the left end
constexpr double kLabel_px = 190.0, kPlot_px = 840.0, kRow_px = 17.0, kAxis_px = 40.0;
constexpr int kStopsATick = 2;

double brightest(const std::vector<PhotographExposure>& exposures) {
  double most = 0.0;
  for (const PhotographExposure& exposure : exposures) most = std::max(most, exposure.radiance.back());
  return most;
}

double place_px(double radiance, double most) {
  const double stops_below = radiance > 0.0 ? std::log2(most / radiance) : kShownStops;
  return kLabel_px + kPlot_px * (1.0 - std::clamp(stops_below, 0.0, kShownStops) / kShownStops);
}

std::string row_of_chart(const PhotographExposure& exposure, double most, double y) {
  std::array<double, 5> x{};
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = place_px(exposure.radiance[i], most);
  const char* colour = exposure.heldout ? kHeldoutColour : kFitColour;
  char shapes[640];
  std::snprintf(shapes, sizeof shapes,
                "<path d=\"M%.1f %.1f H%.1f\" stroke=\"%s\" stroke-width=\"1.5\"/><path d=\"M%.1f %.1f H%.1f\" stroke=\"%s\" stroke-width=\"8\" "
                "stroke-opacity=\"0.45\"/><path d=\"M%.1f %.1f v10\" stroke=\"%s\" stroke-width=\"2.5\"/>\n",
                x[0], y, x[4], colour, x[1], y, x[3], colour, x[2], y - 5.0, colour);
  char label[80];
  std::snprintf(label, sizeof label, "<text x=\"0\" y=\"%.1f\">", y + 4.0);
  return label + html::escaped(exposure.view) + "</text>" + shapes;
}

std::string brightness_chart(const std::vector<PhotographExposure>& exposures) {
  const double most = brightest(exposures), rows_px = kRow_px * static_cast<double>(exposures.size());
  if (!(most > 0.0)) return "";
  char text[240];
  std::snprintf(text, sizeof text, "<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\">\n", kLabel_px + kPlot_px + 20.0, rows_px + kAxis_px);
  std::string svg = text;
  for (int stops = 0; stops <= static_cast<int>(kShownStops); stops += kStopsATick) {
    const double x = place_px(most * std::exp2(-stops), most);
    std::snprintf(text, sizeof text,
                  "<path d=\"M%.1f 0 V%.1f\" stroke=\"#d9dde2\"/><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s%d</text>\n", x, rows_px, x,
                  rows_px + 16.0, stops > 0 ? "−" : "", stops);
    svg += text;
  }
  for (std::size_t i = 0; i < exposures.size(); ++i) svg += row_of_chart(exposures[i], most, kRow_px * (static_cast<double>(i) + 0.5));
  std::snprintf(text, sizeof text, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">stops below the brightest photograph's 99th percentile</text></svg>",
                kLabel_px + 0.5 * kPlot_px, rows_px + 34.0);
  return svg + text;
}

std::string share_cell(const Json& share) {
  return share.is_number() ? html::number(100.0 * share.get<double>(), 2) + " %" : "–";
}

std::string exposure_table(const Json& data) {
  std::vector<std::vector<std::string>> rows;
  const auto cell = [](const Json& value) { return value.is_number() ? html::number(value.get<double>()) : std::string("–"); };
  for (const Json& photograph : data) {
    rows.push_back({photograph.at("photograph").get<std::string>(), photograph.at("heldout").get<bool>() ? "held out" : "fit",
                    cell(photograph.at("exposures")), cell(photograph.at("shortest_s")), cell(photograph.at("longest_s")), cell(photograph.at("stops")),
                    share_cell(photograph.at("clipped_share")), share_cell(photograph.at("dark_share"))});
  }
  return html::table({"photograph", "role", "exposures", "shortest, s", "longest, s", "apart, stops", "clipped", "below noise"}, rows);
}

}  // namespace

Json exposures_json(const std::vector<PhotographExposure>& exposures) {
  Json list = Json::array();
  for (const PhotographExposure& exposure : exposures) {
    const bool bracket = !exposure.exposure_s.empty() && exposure.exposure_s.front() > 0.0;
    Json radiance = Json::object();
    for (std::size_t i = 0; i < kRadianceShares.size(); ++i) radiance[html::number(kRadianceShares[i], 2)] = exposure.radiance[i];
    list.push_back({{"photograph", exposure.view},
                    {"heldout", exposure.heldout},
                    {"exposures", bracket ? Json(exposure.exposure_s.size()) : Json(nullptr)},
                    {"shortest_s", bracket ? Json(exposure.exposure_s.front()) : Json(nullptr)},
                    {"longest_s", bracket ? Json(exposure.exposure_s.back()) : Json(nullptr)},
                    {"stops", bracket ? Json(std::log2(exposure.exposure_s.back() / exposure.exposure_s.front())) : Json(nullptr)},
                    {"clipped_share", exposure.clipped_share},
                    {"dark_share", bracket ? Json(exposure.dark_share) : Json(nullptr)},
                    {"radiance_at_share", radiance}});
  }
  return list;
}

Json setup_json(const CalibratedSession& session) {
  const auto list = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json photographs = Json::array();
  for (const View& view : session.views) {
    photographs.push_back({{"photograph", view.name},
                           {"heldout", view.heldout},
                           {"camera_m", list(view.camera_in_world())},
                           {"light", {{"point", view.light.type == Light::Type::Point}, {"vector", list(view.light.vector_in_world)}}}});
  }
  return photographs;
}

std::string setup_section(const CalibratedSession& session) {
  return html::section("Cameras and lights",
                       "Where the camera (the tip of a triangle, which opens towards what it sees) and the lamp (circles) stood for each photograph, in the mesh's "
                       "frame: there the object stands still, even if on the bench it was the object that turned. Blue: used in the fit. Brown: "
                       "held out. Gray: the object. Point at a mark to read its photograph's name. Directional lights are drawn at the rim.",
                       "<div class=\"row two\">" + html::figure(plan_drawing(session, 0, 1), "Along the world's z axis") +
                           html::figure(plan_drawing(session, 0, 2), "Along the world's y axis") + "</div>\n");
}

std::string exposure_section(const std::vector<PhotographExposure>& exposures, const Json& data) {
  if (exposures.empty()) return "";
  const bool brackets = std::any_of(exposures.begin(), exposures.end(), [](const PhotographExposure& e) { return !e.exposure_s.empty(); });
  const std::string source =
      brackets ? "Each photograph was merged from a bracket of exposures; apart: how many stops (doublings) lie between its shortest and its "
                 "longest. Clipped: too bright even for the shortest. Below noise: too dark even for the longest, as in shadow; such values still count, "
                 "with their uncertainty."
               : "These photographs were made elsewhere and came as finished pictures: the session knows no exposure times and no noise. "
                 "Clipped: at the top of the file's range; a picture of floating-point numbers has no top, so that 0 says nothing there.";
  return html::section("Exposure", source + " Shares are of the object's pixels.",
                       html::figure(brightness_chart(exposures),
                                    "How bright the object is in each photograph. Line: all but the darkest and the brightest hundredth of its "
                                    "pixels. Band: the middle half. Tick: the median. What is darker than the scale, as in deep shadow, ends at its left.") +
                           exposure_table(data));
}

std::string calibration_section(const Json& data) {
  const CalibrationSummary summary = summary_from_json(data);
  return summary.intensity.empty() ? given_poses_section(summary) : calibrated_views_section(summary);
}

}  // namespace lumitexel
