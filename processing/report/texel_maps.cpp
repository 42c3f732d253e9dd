#include "processing/report/texel_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/report/html.h"
#include "processing/report/view_pictures.h"

namespace lumitexel {
namespace {

constexpr std::array kUnknownGray{0.6f, 0.6f, 0.6f};  // darker than the middle of the scale

}  // namespace

bool is_measured(const Model& model, std::size_t texel) {
  return model.material[texel] != Model::kNoMaterial && model.samples.data[texel] > 0.0f;
}

std::string percent(const nlohmann::json& share) { return share.is_number() ? html::number(100.0 * share.get<double>(), 2) + " %" : "–"; }

std::vector<float> values_where_measured(const Model& model, const Image& map, int channel) {
  std::vector<float> values;
  for (std::size_t texel = 0; texel < model.material.size(); ++texel) {
    if (!is_measured(model, texel)) continue;
    values.push_back(map.data[texel * static_cast<std::size_t>(map.channels) + static_cast<std::size_t>(channel)]);
  }
  return values;
}

nlohmann::json share_below(std::vector<float> values, double share) {
  if (values.empty()) return nullptr;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

nlohmann::json spread_of(const std::vector<float>& values) {
  return {{"median", share_below(values, 0.5)}, {"nine_tenths", share_below(values, 0.9)}, {"most", share_below(values, 1.0)}};
}

Model carrying(const Model& model, const Image& map, int channel) {
  Model form;
  form.channels = model.channels;
  form.mesh = model.mesh;
  form.width = model.width;
  form.height = model.height;
  form.material = model.material;
  form.normal = Image(model.width, model.height, 3);
  form.uncertainty = Image(model.width, model.height, 1);
  for (std::size_t texel = 0; texel < form.uncertainty.data.size(); ++texel) {
    form.uncertainty.data[texel] = map.data[texel * static_cast<std::size_t>(map.channels) + static_cast<std::size_t>(channel)];
  }
  form.samples = model.samples;
  return form;
}

Image drawn(const Image& normal, const std::function<double(int x, int y)>& position) {
  Image picture(normal.width, normal.height, 3, 1.0f);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (normal.at(x, y, 0) == 0.0f && normal.at(x, y, 1) == 0.0f && normal.at(x, y, 2) == 0.0f) continue;
      const double at = position(x, y);
      const auto colour = std::isnan(at) ? kUnknownGray : false_colour(std::clamp(at, -1.0, 1.0));
      std::copy(colour.begin(), colour.end(), &picture.at(x, y));
    }
  }
  return picture;
}

std::string figure_with_scale(const Image& picture, const std::string& what, const std::string& caption, const std::string& low_means,
                              const std::string& high_means) {
  return "<div>" + html::figure(html::picture(picture, what), caption) +
         html::colour_scale(false_colour(0.0), false_colour(1.0), low_means, high_means) + "</div>";
}

}  // namespace lumitexel
