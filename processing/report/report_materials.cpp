#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "processing/image/tone_map.h"
#include "processing/report/html.h"
#include "processing/report/material_pictures.h"
#include "processing/report/report_sections.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;

constexpr int kSphereSize_px = 180;

// The same figure of every channel; once where all are equal.
std::string by_channel(const Json& values) {
  const bool same = std::all_of(values.begin(), values.end(), [&](const Json& value) { return value == values.front(); });
  std::string text;
  for (std::size_t c = 0; c < (same ? 1 : values.size()); ++c) {
    text += (c == 0 ? "" : " / ") + html::number(values[c].is_number() ? values[c].get<double>() : NAN, 2);
  }
  return text;
}

// The largest of the channels' relative sigmas, of those that have one: nothing else scatters.
std::string plus_minus(const Json& sigmas) {
  if (sigmas.is_null()) return "";
  double largest = -1.0;
  for (const Json& sigma : sigmas) largest = std::max(largest, sigma.is_number() ? sigma.get<double>() : -1.0);
  return largest < 0.0 ? " (at a bound, or seen by no sample)" : " (± " + html::number(100.0 * largest, 2) + " %)";
}

const char* strength_name(const std::string& family) {
  if (family == to_string(BrdfFamily::Lafortune)) return "peak (1/sr)";
  return family == to_string(BrdfFamily::Ggx) ? "F0" : "albedo";
}

std::string family_name(const std::string& family) {
  if (family == to_string(BrdfFamily::Ggx)) return "GGX";
  return family == to_string(BrdfFamily::Lafortune) ? "Lafortune" : "Ward";
}

std::string lobe_text(const std::string& family, const Json& lobe) {
  return "; " + family_name(family) + " lobe, " + strength_name(family) + " " + by_channel(lobe.at("strength")) + plus_minus(lobe.at("strength_sigma")) +
         (family == to_string(BrdfFamily::Lafortune) ? ", exponent " : ", alpha ") + by_channel(lobe.at("shape")) + plus_minus(lobe.at("shape_sigma"));
}

std::string brdf_text(const Json& material) {
  const auto family = material.at("family").get<std::string>();
  std::string text = "diffuse albedo " + std::string(material.at("diffuse_albedo").size() == 3 ? "(red / green / blue) " : "") +
                     by_channel(material.at("diffuse_albedo")) + plus_minus(material.at("sigma"));
  for (const Json& lobe : material.at("lobes")) text += lobe_text(family, lobe);
  return text;
}

// null where a figure is not finite.
template <typename Value>
Json list_by_channel(int channels, Value value) {
  Json list = Json::array();
  for (int c = 0; c < channels; ++c) {
    const double figure = value(static_cast<std::size_t>(c));
    list.push_back(std::isfinite(figure) ? Json(figure) : Json(nullptr));
  }
  return list;
}

Json lobe_json(const Brdf& brdf, std::size_t index, const std::optional<BrdfSigma>& sigma) {
  const auto& lobe = brdf.lobes[index];
  const auto relative = [&](double LobeSigma::* of) {
    return sigma ? list_by_channel(brdf.channels, [&](std::size_t c) { return sigma->lobes[index][c].*of; }) : Json(nullptr);
  };
  return {{"strength", list_by_channel(brdf.channels, [&](std::size_t c) { return std::exp(lobe[c].log_strength); })},
          {"strength_sigma", relative(&LobeSigma::log_strength)},
          {"shape", list_by_channel(brdf.channels, [&](std::size_t c) { return std::exp(lobe[c].log_shape); })},
          {"shape_sigma", relative(&LobeSigma::log_shape)}};
}

Json material_json(const ModelMaterial& material, double share) {
  const Brdf& brdf = material.brdf;
  Json lobes = Json::array(), sigma = nullptr;
  for (std::size_t l = 0; l < brdf.lobes.size(); ++l) lobes.push_back(lobe_json(brdf, l, material.sigma));
  if (material.sigma) sigma = list_by_channel(brdf.channels, [&](std::size_t c) { return material.sigma->diffuse[c] / brdf.diffuse[c]; });
  return {{"share_of_measured_texels", share},
          {"family", to_string(brdf.family)},
          {"diffuse_albedo", list_by_channel(brdf.channels, [&](std::size_t c) { return std::numbers::pi * brdf.diffuse[c]; })},
          {"sigma", sigma},
          {"lobes", lobes}};
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

std::string sphere_figures(const Model& model, const Json& materials) {
  std::vector<Image> spheres;
  for (const ModelMaterial& material : model.materials)
    spheres.push_back(material_sphere(material.brdf, kSphereSize_px));
  const double white = sphere_white(spheres);
  std::string text = "<div class=\"swatches\">";
  for (std::size_t m = 0; m < spheres.size(); ++m) {
    const std::string share = html::number(100.0 * number_or_nan(materials.at(m), "share_of_measured_texels"), 2);
    text += "<figure>" + html::picture(sphere_picture(spheres[m], white), "sphere of material " + std::to_string(m)) +
            "<figcaption><span class=\"key\" style=\"background:" + html::css_colour(material_colour(static_cast<int>(m))) +
            "\"></span>" +
            html::escaped("Material " + std::to_string(m) + ", " + share + " % of the measured texels; " +
                          brdf_text(materials.at(m))) +
            "</figcaption></figure>\n";
  }
  return text + "</div>\n";
}

}  // namespace

Json materials_json(const Model& model) {
  const std::vector<std::int64_t> texels = texels_by_material(model);
  const auto total = static_cast<double>(std::accumulate(texels.begin(), texels.end(), std::int64_t{0}));
  Json materials = Json::array();
  for (std::size_t m = 0; m < texels.size(); ++m) materials.push_back(material_json(model.materials[m], total > 0.0 ? static_cast<double>(texels[m]) / total : 0.0));
  return materials;
}

std::string material_section(const ReportSubject& subject, const Json& materials, const ViewRenderer& renderer) {
  const std::string map = html::figure(html::picture(material_map(renderer, map_view(subject)), "map of the materials"),
                                       "Every texel in the colour of its material; gray where nothing was measured.");
  return html::section("Materials",
                       "The fit sorted the surface into materials by how it reflects light. Each is shown as a sphere "
                       "of that material's "
                       "mean reflectance under one light from above left, all at one exposure. On the object itself "
                       "every texel mixes its "
                       "material's basis and varies about this mean as far as its photographs ask for it, which may be not at all. An ideal white surface has albedo 1. In brackets one sigma, of the channel least sure, by the scatter of whole surface points; what errs alike in all of them comes on top.",
                       "<div class=\"row\"><div>" + map + "</div><div style=\"grid-column: span 2\">" +
                           sphere_figures(subject.model, materials) + "</div></div>\n");
}

}  // namespace lumitexel
