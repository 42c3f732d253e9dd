#include "processing/fit/fill_atlas.h"

#include <algorithm>
#include <numeric>

namespace lumitexel {
namespace {

constexpr int kFillRounds = 64;  // texels; holes are at most as wide as what a foreground hides
constexpr int kNormalRings = 2;  // as far as a bilinear look-up inside a patch reaches; farther away the form is another

std::vector<std::int16_t> material_map(const Atlas& atlas, const LumitexelSet& lumitexels, const std::vector<int>& label) {
  std::vector<std::int16_t> map(static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height),
                                Model::kNoMaterial);
  std::size_t i = 0;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for (std::size_t k = 0; k < tile.size(); ++k, ++i) map[tile.texel[k]] = static_cast<std::int16_t>(label[i]);
  }
  return map;
}

void copy_texel(Model& model, std::size_t to, std::size_t from) {
  model.material[to] = model.material[from];
  for (Image* weights : {&model.weights, &model.projection_weights}) {
    const auto planes = static_cast<std::size_t>(weights->channels);
    if (planes > 0) std::copy_n(&weights->data[from * planes], planes, &weights->data[to * planes]);
  }
  model.uncertainty.data[to] = 1.0f;  // borrowed, so nothing is known about this very texel
}

bool has_no_normal(const Model& model, std::size_t texel) {
  const float* normal = &model.normal.data[3 * texel];
  return std::all_of(normal, normal + 3, [](float x) { return x == 0.0f; });
}

// Around every texel with a normal, ring by ring, but for surface that no view saw. A look-up between a patch's last lumitexel and the texel beside it
// would else fall back to the mesh's normal half of the way.
void grow_normals(const std::vector<std::uint32_t>& unseen, Model& model) {
  const auto width = static_cast<std::size_t>(model.width), texels = model.material.size();
  for (int ring = 0; ring < kNormalRings; ++ring) {
    std::vector<std::pair<std::size_t, std::size_t>> grown;  // to, from
    for (std::size_t to = 0; to < texels; ++to) {
      if (!has_no_normal(model, to)) continue;
      const std::pair<bool, std::size_t> beside[] = {{to % width > 0, to - 1}, {(to + 1) % width > 0, to + 1}, {to >= width, to - width}, {to + width < texels, to + width}};
      const auto* const from = std::find_if(std::begin(beside), std::end(beside), [&](const auto& there) { return there.first && !has_no_normal(model, there.second); });
      if (from != std::end(beside)) grown.emplace_back(to, from->second);
    }
    for (const auto& [to, from] : grown) std::copy_n(&model.normal.data[3 * from], 3, &model.normal.data[3 * to]);
  }
  for (const std::size_t texel : unseen) std::fill_n(&model.normal.data[3 * texel], 3, 0.0f);
}

int most_common(const std::vector<std::int16_t>& map, std::size_t materials) {
  std::vector<std::size_t> count(materials, 0);
  for (const std::int16_t material : map) {
    if (material != Model::kNoMaterial) ++count[static_cast<std::size_t>(material)];
  }
  return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
}

void fill_unseen(const std::vector<std::uint32_t>& texels, Model& model) {
  const int material = most_common(model.material, model.materials.size());
  for (const std::size_t texel : texels) {
    if (model.material[texel] != Model::kNoMaterial) continue;
    model.material[texel] = static_cast<std::int16_t>(material);
    for (Image* weights : {&model.weights, &model.projection_weights}) {
      if (weights->channels > 0) weights->data[texel * static_cast<std::size_t>(weights->channels)] = 1.0f;
    }
    model.uncertainty.data[texel] = 1.0f;
  }
}

}  // namespace

// Always from texels of earlier rounds. Only the rim of the last round is looked at, so the cost follows the area that is filled.
void fill_holes(Model& model, std::vector<std::size_t> rim) {
  const auto width = static_cast<std::size_t>(model.width), height = static_cast<std::size_t>(model.height);
  for (int round = 0; round < kFillRounds && !rim.empty(); ++round) {
    std::vector<std::pair<std::size_t, std::size_t>> grown;  // to, from
    for (const std::size_t at : rim) {
      const std::size_t x = at % width, y = at / width;
      const auto offer = [&](std::size_t to) {
        if (model.material[to] == Model::kNoMaterial) grown.emplace_back(to, at);
      };
      if (x > 0) offer(at - 1);
      if (x + 1 < width) offer(at + 1);
      if (y > 0) offer(at - width);
      if (y + 1 < height) offer(at + width);
    }
    rim.clear();
    for (const auto& [to, from] : grown) {
      if (model.material[to] != Model::kNoMaterial) continue;
      copy_texel(model, to, from);
      rim.push_back(to);
    }
  }
}

void fill_atlas(const Atlas& atlas, const LumitexelSet& lumitexels, const std::vector<int>& label,
                const std::vector<TexelWeights>& weights, const std::vector<TexelWeights>& projection, Model& model) {
  std::size_t largest_basis = 1;
  for (const ModelMaterial& material : model.materials) largest_basis = std::max(largest_basis, material.basis.size());
  model.width = atlas.width;
  model.height = atlas.height;
  model.mesh = atlas.mesh;
  model.material.assign(static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height),
                        Model::kNoMaterial);
  model.weights = Image(atlas.width, atlas.height, static_cast<int>(largest_basis));
  if (!projection.empty()) model.projection_weights = model.weights;
  model.normal = Image(atlas.width, atlas.height, 3);
  model.uncertainty = Image(atlas.width, atlas.height, 1);
  model.samples = Image(atlas.width, atlas.height, 1);
  std::vector<std::size_t> filled;
  std::size_t i = 0;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for (std::size_t k = 0; k < tile.size(); ++k, ++i) {
      const std::size_t texel = tile.texel[k];
      const std::uint32_t count = tile.first_sample[k + 1] - tile.first_sample[k];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        model.normal.data[3 * texel + axis] = static_cast<float>(tile.normal[k][static_cast<Eigen::Index>(axis)]);
      }
      model.samples.data[texel] = static_cast<float>(count);
      if (count == 0) continue;
      model.material[texel] = static_cast<std::int16_t>(label[i]);
      std::copy(weights[i].weight.begin(), weights[i].weight.end(), &model.weights.data[texel * largest_basis]);
      if (!projection.empty()) {
        std::copy(projection[i].weight.begin(), projection[i].weight.end(), &model.projection_weights.data[texel * largest_basis]);
      }
      model.uncertainty.data[texel] = weights[i].relative_sigma;
      filled.push_back(texel);
    }
  }
  fill_unseen(atlas.unseen_texels, model);  // first, so that no neighbour grows into them
  fill_holes(model, std::move(filled));
  if (has_normals(model)) grow_normals(atlas.unseen_texels, model);
}

std::vector<std::vector<std::size_t>> neighbour_counts(const Atlas& atlas, const LumitexelSet& lumitexels,
                                                       const std::vector<int>& label, std::size_t materials) {
  const std::vector<std::int16_t> map = material_map(atlas, lumitexels, label);
  const auto width = static_cast<std::size_t>(atlas.width);
  std::vector<std::vector<std::size_t>> counts(materials, std::vector<std::size_t>(materials, 0));
  const auto note = [&](std::size_t a, std::size_t b) {
    if (map[a] == Model::kNoMaterial || map[b] == Model::kNoMaterial) return;
    ++counts[static_cast<std::size_t>(map[a])][static_cast<std::size_t>(map[b])];
    ++counts[static_cast<std::size_t>(map[b])][static_cast<std::size_t>(map[a])];
  };
  for (std::size_t at = 0; at < map.size(); ++at) {
    if ((at + 1) % width != 0) note(at, at + 1);
    if (at + width < map.size()) note(at, at + width);
  }
  return counts;
}

}  // namespace lumitexel
