#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/report/html.h"
#include "processing/report/report_sections.h"
#include "processing/report/view_pictures.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr int kPictureWidth_px = 460;
constexpr int kMapSize_px = 520;
constexpr std::size_t kMostComparisons = 8;  // a page that still opens at once

std::string difference_scale() {
  const std::string percent = html::number(100.0 * kDifferenceRange);
  return "<div class=\"scale\"><div class=\"bar\" style=\"background:linear-gradient(to right," +
         html::css_colour(false_colour(-1.0)) + "," + html::css_colour(false_colour(0.0)) + "," + html::css_colour(false_colour(1.0)) +
         ")\"></div><div class=\"ends\"><span>rendering darker by " + percent + " % of white</span><span>equal</span>" +
         "<span>brighter by " + percent + " %</span></div></div>\n";
}

std::vector<std::size_t> views_to_show(const std::vector<View>& views) {
  std::vector<std::size_t> heldout, fit;
  for (std::size_t i = 0; i < views.size(); ++i) (views[i].heldout ? heldout : fit).push_back(i);
  std::vector<std::size_t>& shown = heldout.empty() ? fit : heldout;
  if (shown.size() > kMostComparisons) shown.resize(kMostComparisons);
  return shown;
}

// white, error: of the photograph, as the JSON has them.
std::string comparison(const View& view, const ViewPictures& pictures, const Json& white, const Json& error) {
  const std::string figures = "relative RMS " + html::number(number_or_nan(error, "relative_rms")) + ", PSNR " + html::number(number_or_nan(error, "psnr_db")) + " dB";
  return "<h3>" + html::escaped(view.name) + (view.heldout ? " (held out)" : " (used in the fit)") +
         "</h3><div class=\"row\">" +
         html::figure(html::picture(pictures.photograph, "photograph " + view.name),
                      "Photograph; white is a radiance of " + html::number(number_or_nan(white, "white")) + " in the photographs' own unit") +
         html::figure(html::picture(pictures.rendering, "rendering of " + view.name),
                      "Rendering, same exposure; " + figures) +
         html::figure(html::picture(pictures.difference, "difference in " + view.name), "Rendering minus photograph") +
         "</div>\n";
}

// The same view cut down to the object and enlarged until its longer side is the picture's.
View tightened(View view, const Mesh& mesh) {
  CameraModel& camera = view.camera;
  Eigen::Vector2d low(camera.width_px, camera.height_px), high = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& position : mesh.positions) {
    const Eigen::Vector2d pixel = camera.project(view.camera_from_world * position);
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  constexpr double kMargin_px = 4.0;
  const double scale = (kMapSize_px - 2.0 * kMargin_px) / (high - low).maxCoeff();
  const Eigen::Vector2d size = scale * (high - low);
  camera = {static_cast<int>(std::ceil(size.x() + 2.0 * kMargin_px)), static_cast<int>(std::ceil(size.y() + 2.0 * kMargin_px)),
            scale * camera.focal_x_px, scale * camera.focal_y_px, scale * (camera.principal_x_px - low.x()) + kMargin_px,
            scale * (camera.principal_y_px - low.y()) + kMargin_px};
  return view;
}

}  // namespace

View map_view(const ReportSubject& subject) {
  const Mesh& mesh = subject.model.mesh;
  Eigen::Vector3d towards_camera(0.4, -1.0, 0.5), up = Eigen::Vector3d::UnitZ();
  if (subject.session != nullptr && !subject.session->views.empty()) {
    const View& view = subject.session->views[views_to_show(subject.session->views).front()];
    towards_camera = -view.camera_from_world.inverse().linear().col(2);
    up = -view.camera_from_world.inverse().linear().col(1);
  }
  return tightened(framing_view(mesh, subject.model.channels, kMapSize_px, towards_camera, up), mesh);
}

Json shown_json(const ReportSubject& subject, const ViewRenderer& renderer) {
  Json shown = Json::array();
  for (const std::size_t v : views_to_show(subject.session->views)) {
    const View& view = subject.session->views[v];
    shown.push_back({{"photograph", view.name}, {"white", shown_white(renderer, view, subject.model.channels)}});
  }
  return shown;
}

std::string comparison_section(const ReportSubject& subject, const Json& whites, const Json& evaluation, const ViewRenderer& renderer, Progress& progress) {
  const auto& views = subject.session->views;
  const std::vector<std::size_t> shown = views_to_show(views);
  const bool heldout = !shown.empty() && views[shown.front()].heldout;
  std::string body = difference_scale();
  progress.begin("picture comparisons", static_cast<std::int64_t>(shown.size()), "views");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const View& view = views[shown[i]];
    const ViewPictures pictures =
        make_view_pictures(renderer, view, subject.model.channels, subject.evaluation->last_stage, kPictureWidth_px);
    body += comparison(view, pictures, whites.at(i), evaluation.at("views").at(shown[i]));
    progress.update(static_cast<std::int64_t>(i + 1));
  }
  const std::string what =
      heldout
          ? "These photographs were kept out of the fit: the model had to predict them from the others. "
          : "No photograph was kept out of the fit, so these only show how well the model repeats what it has seen. ";
  return html::section(heldout ? "Photographs the model never saw" : "Photographs and their re-renderings",
                       what +
                           "Photograph and rendering are shown at one exposure, chosen so that the photograph's 99th "
                           "percentile is white, on the sRGB curve; pixels that were not compared are black.",
                       body);
}

}  // namespace lumitexel
