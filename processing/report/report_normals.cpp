#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "processing/export/exported_normals.h"
#include "processing/image/tone_map.h"
#include "processing/report/html.h"
#include "processing/report/report_sections.h"
#include "processing/report/texel_maps.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kUnmovedTilt_rad = 0.1 * kDegree;  // below it a normal is called the mesh's: far below any sigma
constexpr double kFullTilt_deg = 20.0, kFullSigma_deg = 10.0;

// Angles in degrees; from both components, since the cosine of a small angle keeps few of its digits.
double tilt_deg(const Image& tangent, std::size_t texel) {
  const float* n = &tangent.data[3 * texel];
  return std::atan2(std::hypot(n[0], n[1]), n[2]) / kDegree;
}

Eigen::Vector3d vector_at(const Image& image, int x, int y) { return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)}; }

// White plaster under a light from the left and half as much from the right, each 20 degrees above the picture's plane. No shadows are cast.
Image plaster(const Image& normal, const View& view) {
  const Eigen::Matrix3d world_from_camera = view.camera_from_world.inverse().linear();
  const double aside = std::cos(20.0 * kDegree), ahead = -std::sin(20.0 * kDegree);  // the camera looks along +z
  const Eigen::Vector3d left = world_from_camera * Eigen::Vector3d(-aside, 0.0, ahead), right = world_from_camera * Eigen::Vector3d(aside, 0.0, ahead);
  Image shown(normal.width, normal.height, 1, 1.0f);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const Eigen::Vector3d n = vector_at(normal, x, y);
      if (!n.isZero()) shown.at(x, y) = static_cast<float>(std::max(0.0, n.dot(left)) + 0.5 * std::max(0.0, n.dot(right)));
    }
  }
  return tone_mapped(shown, 1.0);
}

std::string degrees(const Json& value) { return value.is_number() ? html::number(value.get<double>(), 2) + "°" : "–"; }

std::string full_angle(double full_deg) { return html::number(full_deg) + "° and more"; }

std::string text_of(const Json& data) {
  const auto count = [&](const char* key) { return html::number(data.at(key).get<double>(), 8); };
  return "The mesh that the measurement began with is coarser than the photographs. From how each point brightens and darkens as the lamp moves, "
         "its normal (the direction that the surface faces) was fitted, so that small relief shows that the mesh does not have. Of " +
         count("texels_measured") + " measured texels, " + count("texels_on_the_meshs_normal") +
         " kept the mesh's normal, to within " + html::number(kUnmovedTilt_rad / kDegree, 1) + "°.";
}

}  // namespace

Json normals_json(const Model& model) {
  if (!has_normals(model)) return nullptr;
  const ExportedNormals normals = export_normals(model);
  std::vector<float> tilts, sigmas;
  for (std::size_t texel = 0; texel < model.material.size(); ++texel) {
    if (!is_measured(model, texel)) continue;
    tilts.push_back(static_cast<float>(tilt_deg(normals.tangent, texel)));
    sigmas.push_back(static_cast<float>(model.normal_sigma.data[texel] / kDegree));
  }
  const auto unmoved = std::count_if(tilts.begin(), tilts.end(), [](double tilt) { return tilt * kDegree < kUnmovedTilt_rad; });
  return {{"texels_measured", tilts.size()},
          {"texels_on_the_meshs_normal", unmoved},
          {"within_deg", kUnmovedTilt_rad / kDegree},
          {"tilt_against_mesh_deg", spread_of(tilts)},
          {"sigma_deg", spread_of(sigmas)}};
}

std::string normals_section(const ReportSubject& subject, const Json& data, const ViewRenderer& renderer, const View& view) {
  if (!data.is_object()) return "";
  const Model form = carrying(subject.model, subject.model.normal_sigma);
  const ViewRenderer form_renderer(form);
  const Image before = form_renderer.render_aov(view, Aov::Normal), after = renderer.render_aov(view, Aov::Normal);
  const Image sigma = form_renderer.render_aov(view, Aov::Sigma), samples = form_renderer.render_aov(view, Aov::Samples);
  const auto where_measured = [&](int x, int y, double value) { return samples.at(x, y) > 0.0f ? value : NAN; };
  const Image tilt_picture = drawn(after, [&](int x, int y) {
    const Eigen::Vector3d a = vector_at(before, x, y), b = vector_at(after, x, y);
    return where_measured(x, y, std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree / kFullTilt_deg);
  });
  const Image sigma_picture = drawn(after, [&](int x, int y) { return where_measured(x, y, sigma.at(x, y) / kDegree / kFullSigma_deg); });
  const Json &tilt = data.at("tilt_against_mesh_deg"), &sigmas = data.at("sigma_deg");
  return html::section(
      "Fine relief: the normals", text_of(data),
      "<div class=\"row two\">" +
          html::figure(html::picture(plaster(before, view), "the mesh's normals under raking light"),
                       "Before: the mesh's own normals, as white plaster under raking light from the left and, half as strong, from the right. No shadows are cast.") +
          html::figure(html::picture(plaster(after, view), "the fitted normals under raking light"),
                       "After: the fitted normals, the same plaster and lights.") +
          "</div><div class=\"row two\">" +
          figure_with_scale(tilt_picture, "tilt against the mesh",
                            "How far each normal was turned away from the mesh's: half of the measured texels by at most " +
                                degrees(tilt.at("median")) + ", nine tenths by at most " + degrees(tilt.at("nine_tenths")) + ". Gray: not measured.",
                            "0°", full_angle(kFullTilt_deg)) +
          figure_with_scale(sigma_picture, "sigma of the normals",
                            "How uncertain the fitted normal is, one sigma per axis: half of the measured texels at most " +
                                degrees(sigmas.at("median")) + ", nine tenths at most " + degrees(sigmas.at("nine_tenths")) +
                                ". It follows from the scatter of the samples, widened by how far two halves of the photographs disagree, and from what the mesh and the "
                                "neighbours leave open. What all photographs share, such as a wrong pose or material, comes on top: on a test "
                                "object of known form errors were about twice as large. Gray: not measured.",
                            "0°", full_angle(kFullSigma_deg)) +
          "</div>\n");
}

}  // namespace lumitexel
