#include <cmath>
#include <numbers>

#include "processing/image/tone_map.h"
#include "processing/report/html.h"
#include "processing/report/material_pictures.h"
#include "processing/report/report_sections.h"
#include "processing/report/view_pictures.h"

namespace lumitexel {
namespace {

constexpr int kPictureWidth_px = 460;
constexpr int kSphereSize_px = 180;
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

std::string comparison(const View& view, const ViewPictures& pictures, const ViewEvaluation& evaluation) {
  const std::string figures = "relative RMS " + html::number(evaluation.error.relative_rms) + ", PSNR " +
                              html::number(evaluation.error.psnr_db) + " dB";
  return "<h3>" + html::escaped(view.name) + (view.heldout ? " (held out)" : " (used in the fit)") +
         "</h3><div class=\"row\">" +
         html::figure(html::picture(pictures.photograph, "photograph " + view.name),
                      "Photograph; white is a radiance of " + html::number(pictures.white) + " in the photographs' own unit") +
         html::figure(html::picture(pictures.rendering, "rendering of " + view.name),
                      "Rendering, same exposure; " + figures) +
         html::figure(html::picture(pictures.difference, "difference in " + view.name), "Rendering minus photograph") +
         "</div>\n";
}

// The same figure of every channel; once where all are equal.
template <typename Value>
std::string by_channel(int channels, Value value) {
  const bool same = channels > 1 && value(0) == value(1) && value(0) == value(channels - 1);
  std::string text = html::number(value(0), 2);
  for (int c = 1; c < channels && !same; ++c) text += " / " + html::number(value(c), 2);
  return text;
}

// The largest of the channels' sigmas, as a share of the figure itself, of those that have one: nothing else scatters.
template <typename Sigma>
std::string plus_minus(int channels, Sigma relative_sigma) {
  double largest = -1.0;
  for (int c = 0; c < channels; ++c) {
    if (std::isfinite(relative_sigma(c))) largest = std::max(largest, relative_sigma(c));
  }
  return largest < 0.0 ? " (at a bound, or seen by no sample)" : " (± " + html::number(100.0 * largest, 2) + " %)";
}

const char* strength_name(BrdfFamily family) {
  if (family == BrdfFamily::Lafortune) return "peak (1/sr)";
  return family == BrdfFamily::Ggx ? "F0" : "albedo";
}

std::string family_name(BrdfFamily family) {
  if (family == BrdfFamily::Ggx) return "GGX";
  return family == BrdfFamily::Lafortune ? "Lafortune" : "Ward";
}

std::string lobe_text(const Brdf& brdf, std::size_t index, const std::optional<BrdfSigma>& sigma) {
  const auto lobe = [&](int c) { return brdf.lobes[index][static_cast<std::size_t>(c)]; };
  const auto lobe_sigma = [&](int c) { return sigma->lobes[index][static_cast<std::size_t>(c)]; };
  const int channels = brdf.channels;
  std::string text = "; " + family_name(brdf.family) + " lobe, " + strength_name(brdf.family) + " " + by_channel(channels, [&](int c) { return std::exp(lobe(c).log_strength); });
  if (sigma) text += plus_minus(channels, [&](int c) { return lobe_sigma(c).log_strength; });
  text += std::string(brdf.family == BrdfFamily::Lafortune ? ", exponent " : ", alpha ") + by_channel(channels, [&](int c) { return std::exp(lobe(c).log_shape); });
  if (sigma) text += plus_minus(channels, [&](int c) { return lobe_sigma(c).log_shape; });
  return text;
}

std::string brdf_text(const ModelMaterial& material) {
  const Brdf& brdf = material.brdf;
  const auto diffuse = [&](int c) { return brdf.diffuse[static_cast<std::size_t>(c)]; };
  std::string text = "diffuse albedo " + std::string(brdf.channels == 3 ? "(red / green / blue) " : "") +
                     by_channel(brdf.channels, [&](int c) { return std::numbers::pi * diffuse(c); });
  if (material.sigma) text += plus_minus(brdf.channels, [&](int c) { return material.sigma->diffuse[static_cast<std::size_t>(c)] / diffuse(c); });
  for (std::size_t lobe = 0; lobe < brdf.lobes.size(); ++lobe) text += lobe_text(brdf, lobe, material.sigma);
  return text;
}

// Tone-mapped, on the page's white instead of black: a sphere's dark side then still shows its rim.
Image sphere_picture(const Image& sphere, double white) {
  Image shown = tone_mapped(sphere, white);
  const double middle = 0.5 * sphere.width, radius = middle - 1.0;
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const bool outside = std::hypot(x + 0.5 - middle, y + 0.5 - middle) >= radius;
      for (int c = 0; c < 3 && outside; ++c) shown.at(x, y, c) = 1.0f;
    }
  }
  return shown;
}

std::string sphere_figures(const Model& model) {
  std::vector<Image> spheres;
  for (const ModelMaterial& material : model.materials)
    spheres.push_back(material_sphere(material.brdf, kSphereSize_px));
  const double white = sphere_white(spheres);
  const auto texels = texels_by_material(model);
  double total = 0.0;
  for (const std::int64_t count : texels) total += static_cast<double>(count);
  std::string text = "<div class=\"swatches\">";
  for (std::size_t m = 0; m < spheres.size(); ++m) {
    const std::string share = html::number(100.0 * static_cast<double>(texels[m]) / total, 2);
    text += "<figure>" + html::picture(sphere_picture(spheres[m], white), "sphere of material " + std::to_string(m)) +
            "<figcaption><span class=\"key\" style=\"background:" + html::css_colour(material_colour(static_cast<int>(m))) +
            "\"></span>" +
            html::escaped("Material " + std::to_string(m) + ", " + share + " % of the measured texels; " +
                          brdf_text(model.materials[m])) +
            "</figcaption></figure>\n";
  }
  return text + "</div>\n";
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

std::string comparison_section(const ReportSubject& subject, const ViewRenderer& renderer, Progress& progress) {
  const auto& views = subject.session->views;
  const std::vector<std::size_t> shown = views_to_show(views);
  const bool heldout = !shown.empty() && views[shown.front()].heldout;
  std::string body = difference_scale();
  progress.begin("picture comparisons", static_cast<std::int64_t>(shown.size()), "views");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const View& view = views[shown[i]];
    const ViewPictures pictures =
        make_view_pictures(renderer, view, subject.model.channels, subject.evaluation->last_stage, kPictureWidth_px);
    body += comparison(view, pictures, subject.evaluation->views[shown[i]]);
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

std::string material_section(const ReportSubject& subject, const ViewRenderer& renderer) {
  const std::string map = html::figure(html::picture(material_map(renderer, map_view(subject)), "map of the materials"),
                                       "Every texel in the colour of its material; gray where nothing was measured.");
  return html::section("Materials",
                       "The fit sorted the surface into materials by how it reflects light. Each is shown as a sphere "
                       "of that material's "
                       "mean reflectance under one light from above left, all at one exposure. On the object itself "
                       "every texel mixes its "
                       "material's basis and varies about this mean as far as its photographs ask for it, which may be not at all. An ideal white surface has albedo 1. In brackets one sigma, of the channel least sure, by the scatter of whole surface points; what errs alike in all of them comes on top.",
                       "<div class=\"row\"><div>" + map + "</div><div style=\"grid-column: span 2\">" +
                           sphere_figures(subject.model) + "</div></div>\n");
}

}  // namespace lumitexel
