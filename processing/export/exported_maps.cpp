#include "processing/export/exported_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "processing/export/nearest_texel.h"
#include "processing/export/refit.h"
#include "processing/image/tone_map.h"

namespace lumitexel {
namespace {

std::size_t texel_index(const Model& model, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x);
}

float rounded(double unit) { return static_cast<float>(std::round(255.0 * std::clamp(unit, 0.0, 1.0)) / 255.0); }

// To the next step up, so that F0 stays below: a hundredth of a step is nothing.
double raised(double unit) { return std::ceil(255.0 * std::clamp(unit, 0.0, 1.0) - 0.01) / 255.0; }

std::array<double, 3> highlight_shares(const GltfMaterial& texel) {
  const double specular = raised(texel.specular);
  std::array<double, 3> shares{};
  for (std::size_t c = 0; c < 3 && specular > 0.0; ++c) shares[c] = std::min(texel.f0[c] / specular, 1.0);
  return shares;
}

std::vector<GltfMaterial> refit_texels(const Model& model, MaterialForm form, Progress& progress) {
  std::vector<MaterialRefit> refits;
  for (const ModelMaterial& material : model.materials) refits.emplace_back(material.basis, form);
  std::vector<GltfMaterial> texels(model.material.size());
  progress.begin("refitting texels", model.height, "rows");
  std::atomic<int> done = 0;
  tbb::parallel_for(0, model.height, [&](int y) {
    for (int x = 0; x < model.width; ++x) {
      const std::size_t t = texel_index(model, x, y);
      if (model.material[t] == Model::kNoMaterial) continue;
      const std::span<const float> weights(&model.weights.data[model.weights.offset(x, y)],
                                           static_cast<std::size_t>(model.weights.channels));
      texels[t] = refits[static_cast<std::size_t>(model.material[t])].fit(weights);
    }
    progress.update(++done);
  });
  return texels;
}

}  // namespace

RefittedAtlas refit_atlas(const Model& model, MaterialForm form, Progress& progress) {
  const std::vector<GltfMaterial> fitted = refit_texels(model, form, progress);
  std::vector<std::uint8_t> known(model.material.size());
  for (std::size_t t = 0; t < known.size(); ++t) known[t] = model.material[t] != Model::kNoMaterial ? 1 : 0;
  const std::vector<std::size_t> source = nearest_known_texel(model.width, model.height, known);
  RefittedAtlas atlas{form, model.width, model.height, {}, export_normals(model, form)};
  atlas.texels.reserve(fitted.size());
  for (const std::size_t from : source) atlas.texels.push_back(fitted[from]);
  return atlas;
}

ExportedMaps textures_of(const RefittedAtlas& atlas) {
  const int width = atlas.width, height = atlas.height;
  ExportedMaps maps{atlas.form, Image(width, height, 3), Image(width, height, 3), Image(width, height, 1), Image(width, height, 1), {}};
  for (const GltfMaterial& texel : atlas.texels) {
    for (const double share : highlight_shares(texel)) maps.most_share = std::max(maps.most_share, share);
  }
  if (atlas.form == MaterialForm::Mitsuba) maps.most_share = 1.0;
  for (std::size_t t = 0; t < atlas.texels.size(); ++t) {
    const GltfMaterial& texel = atlas.texels[t];
    const std::array<double, 3> shares = highlight_shares(texel);
    for (std::size_t c = 0; c < 3; ++c) {
      const double share = maps.most_share > 0.0 ? shares[c] / maps.most_share : 0.0;
      maps.base.data[3 * t + c] = rounded(srgb_encoded(static_cast<float>(texel.base[c])));
      maps.specular.data[3 * t + c] = rounded(srgb_encoded(static_cast<float>(share)));
    }
    maps.roughness.data[t] = rounded(texel.roughness);
    maps.specular_factor.data[t] = static_cast<float>(raised(texel.specular));
  }
  if (atlas.normals.tilt_rms_rad > kLeastStatedTilt_rad) maps.normal = coded_normals(atlas.normals.tangent);
  return maps;
}

ExportedMaps refit_maps(const Model& model, Progress& progress, MaterialForm form) { return textures_of(refit_atlas(model, form, progress)); }

Image coded_normals(const Image& normals) {
  Image coded = normals;
  for (float& value : coded.data) value = rounded(0.5 * value + 0.5);
  return coded;
}

Eigen::Vector3d decoded_normal(const Image& coded, int x, int y) {
  return 2.0 * Eigen::Vector3d(coded.at(x, y, 0), coded.at(x, y, 1), coded.at(x, y, 2)) - Eigen::Vector3d::Ones();
}

double srgb_decoded(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

GltfMaterial decoded_texel(const ExportedMaps& maps, int x, int y) {
  GltfMaterial texel;
  texel.specular = maps.specular_factor.at(x, y);
  texel.f0 = decoded_highlight_share(maps, x, y);
  for (int c = 0; c < 3; ++c) {
    texel.base[static_cast<std::size_t>(c)] = srgb_decoded(maps.base.at(x, y, c));
    texel.f0[static_cast<std::size_t>(c)] *= texel.specular;
  }
  texel.roughness = maps.roughness.at(x, y);
  return texel;
}

std::array<double, 3> decoded_highlight_share(const ExportedMaps& maps, int x, int y) {
  std::array<double, 3> share{};
  for (int c = 0; c < 3; ++c) share[static_cast<std::size_t>(c)] = maps.most_share * srgb_decoded(maps.specular.at(x, y, c));
  return share;
}

}  // namespace lumitexel
