#include "processing/export/exported_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "processing/export/refit.h"
#include "processing/image/tone_map.h"

namespace lumitexel {
namespace {

std::size_t texel_index(const Model& model, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x);
}

// For every texel the nearest (breadth first, over edges) that has a material; itself where it has one.
std::vector<std::size_t> nearest_with_material(const Model& model) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> source(model.material.size(), kNone), queue;
  for (std::size_t t = 0; t < source.size(); ++t) {
    if (model.material[t] == Model::kNoMaterial) continue;
    source[t] = t;
    queue.push_back(t);
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::size_t from = queue[head];
    const int x = static_cast<int>(from % static_cast<std::size_t>(model.width));
    const int y = static_cast<int>(from / static_cast<std::size_t>(model.width));
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= model.width || y + dy >= model.height) continue;
      const std::size_t to = texel_index(model, x + dx, y + dy);
      if (source[to] != kNone) continue;
      source[to] = source[from];
      queue.push_back(to);
    }
  }
  for (std::size_t t = 0; t < source.size(); ++t) {
    if (source[t] == kNone) source[t] = t;  // a model without any material: black
  }
  return source;
}

float rounded(double unit) { return static_cast<float>(std::round(255.0 * std::clamp(unit, 0.0, 1.0)) / 255.0); }

std::vector<GltfMaterial> refit_texels(const Model& model, Progress& progress) {
  std::vector<MaterialRefit> refits;
  for (const ModelMaterial& material : model.materials) refits.emplace_back(material.basis);
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

ExportedMaps refit_maps(const Model& model, Progress& progress) {
  const std::vector<GltfMaterial> texels = refit_texels(model, progress);
  const std::vector<std::size_t> source = nearest_with_material(model);
  ExportedMaps maps{Image(model.width, model.height, 3), Image(model.width, model.height, 3), Image(model.width, model.height, 1)};
  for (std::size_t t = 0; t < texels.size(); ++t) {
    if (model.material[t] == Model::kNoMaterial) continue;
    for (const double f0 : texels[t].f0) maps.most_f0 = std::max(maps.most_f0, f0);
  }
  for (std::size_t t = 0; t < texels.size(); ++t) {
    const GltfMaterial& texel = texels[source[t]];
    for (std::size_t c = 0; c < 3; ++c) {
      const double share = maps.most_f0 > 0.0 ? texel.f0[c] / maps.most_f0 : 0.0;
      maps.base.data[3 * t + c] = rounded(srgb_encoded(static_cast<float>(texel.base[c])));
      maps.specular.data[3 * t + c] = rounded(srgb_encoded(static_cast<float>(share)));
    }
    maps.roughness.data[t] = rounded(texel.roughness);
  }
  return maps;
}

double srgb_decoded(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

GltfMaterial decoded_texel(const ExportedMaps& maps, int x, int y) {
  GltfMaterial texel;
  for (int c = 0; c < 3; ++c) {
    texel.base[static_cast<std::size_t>(c)] = srgb_decoded(maps.base.at(x, y, c));
    texel.f0[static_cast<std::size_t>(c)] = maps.most_f0 * srgb_decoded(maps.specular.at(x, y, c));
  }
  texel.roughness = maps.roughness.at(x, y);
  return texel;
}

}  // namespace lumitexel
