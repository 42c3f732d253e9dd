#include "processing/fit/mip_levels.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "processing/fit/fill_atlas.h"
#include "processing/fit/provenance.h"

namespace lumitexel {
namespace {

// Every material's basis, one after the other, and where each begins.
struct CommonBasis {
  std::vector<Brdf> brdfs;
  std::vector<std::size_t> first;
};

CommonBasis common_basis(const Model& model) {
  CommonBasis common;
  for (const ModelMaterial& material : model.materials) {
    common.first.push_back(common.brdfs.size());
    common.brdfs.insert(common.brdfs.end(), material.basis.begin(), material.basis.end());
  }
  return common;
}

struct TexelSum {
  double count = 0;
  std::vector<double> weights, by_material;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double variance = 0, samples = 0;
  std::array<double, 2> indirect{};
};

void add_texel(const Model& model, std::size_t texel, const CommonBasis& common, TexelSum& sum) {
  const auto material = static_cast<std::size_t>(model.material[texel]);
  sum.weights.resize(common.brdfs.size());
  sum.by_material.resize(model.materials.size());
  sum.count += 1.0;
  sum.by_material[material] += 1.0;
  const float* weight = &model.weights.data[texel * static_cast<std::size_t>(model.weights.channels)];
  for (std::size_t k = 0; k < model.materials[material].basis.size(); ++k) sum.weights[common.first[material] + k] += static_cast<double>(weight[k]);
  for (Eigen::Index k = 0; k < 3; ++k) sum.normal[k] += static_cast<double>(model.normal.data[3 * texel + static_cast<std::size_t>(k)]);
  const auto sigma = static_cast<double>(model.uncertainty.data[texel]);
  sum.variance += sigma * sigma;
  sum.samples += static_cast<double>(model.samples.data[texel]);
  for (std::size_t k = 0; k < 2 && !model.indirect.data.empty(); ++k) sum.indirect[k] += static_cast<double>(model.indirect.data[2 * texel + k]);
}

std::vector<TexelSum> sums_of(const Model& model, const CoarserLayout& layout, const CommonBasis& common) {
  std::vector<TexelSum> sums(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height));
  for (const bool borrowed : {false, true}) {
    std::vector<std::uint8_t> known(sums.size(), 0);
    for (std::size_t i = 0; i < sums.size(); ++i) known[i] = sums[i].count > 0;
    for (const auto& [texel, coarser] : layout.parts) {
      if (model.material[texel] == Model::kNoMaterial || (model.samples.data[texel] == 0.0f) != borrowed || (borrowed && known[coarser] != 0)) continue;
      add_texel(model, texel, common, sums[coarser]);
    }
  }
  return sums;
}

std::string level_provenance(const Model& model, int level, const char* way) {
  const auto whole = nlohmann::json::parse(model.provenance_json);
  nlohmann::json kept = {{"level", level}, {"way", way}};
  for (const char* key : {"session_key", "options", "layout"}) {
    if (whole.contains(key)) kept[key] = whole.at(key);
  }
  return kept.dump();
}

// The texel of surface that no view saw, in an atlas cut from photographs: as it is in the model.
void copy_unseen(const Model& model, const CommonBasis& common, std::vector<TexelSum>& sums) {
  if (sums[0].count == 0 && model.material[0] != Model::kNoMaterial) add_texel(model, 0, common, sums[0]);
}

}  // namespace

CoarserLayout level_layout(const Model& model, int level) {
  return coarser_layout(model.mesh, model.width, model.height, level, layout_of(model).choice != LayoutChoice::Mesh);
}

Model averaged_level(const Model& model, int level) {
  const CoarserLayout layout = level_layout(model, level);
  const CommonBasis common = common_basis(model);
  std::vector<TexelSum> sums = sums_of(model, layout, common);
  copy_unseen(model, common, sums);
  Model result;
  result.channels = model.channels;
  result.single = model.single;
  for (const ModelMaterial& material : model.materials) result.materials.push_back({material.brdf, common.brdfs, {}});
  result.mesh = layout.mesh;
  result.width = layout.width;
  result.height = layout.height;
  result.material.assign(sums.size(), Model::kNoMaterial);
  result.weights = Image(layout.width, layout.height, static_cast<int>(common.brdfs.size()));
  result.normal = Image(layout.width, layout.height, 3);
  result.uncertainty = Image(layout.width, layout.height, 1);
  result.samples = Image(layout.width, layout.height, 1);
  result.indirect_bounces = model.indirect_bounces;
  if (!model.indirect.data.empty()) result.indirect = Image(layout.width, layout.height, 2);
  std::vector<std::size_t> filled;
  for (std::size_t texel = 0; texel < sums.size(); ++texel) {
    const TexelSum& sum = sums[texel];
    if (sum.count == 0) continue;
    const auto most = std::max_element(sum.by_material.begin(), sum.by_material.end());
    result.material[texel] = static_cast<std::int16_t>(most - sum.by_material.begin());
    for (std::size_t k = 0; k < sum.weights.size(); ++k) {
      result.weights.data[texel * sum.weights.size() + k] = static_cast<float>(sum.weights[k] / sum.count);
    }
    const Eigen::Vector3d normal = sum.normal.norm() > 1e-6 * sum.count ? Eigen::Vector3d(sum.normal.normalized()) : Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) result.normal.data[3 * texel + k] = static_cast<float>(normal[static_cast<Eigen::Index>(k)]);
    result.uncertainty.data[texel] = static_cast<float>(std::sqrt(sum.variance / sum.count));
    result.samples.data[texel] = static_cast<float>(sum.samples);
    for (std::size_t k = 0; k < 2 && !result.indirect.data.empty(); ++k) {
      result.indirect.data[2 * texel + k] = static_cast<float>(sum.indirect[k] / sum.count);
    }
    filled.push_back(texel);
  }
  fill_holes(result, std::move(filled));
  result.provenance_json = level_provenance(model, level, "averaged");
  return result;
}

std::filesystem::path levels_directory(const std::filesystem::path& model) { return model / "levels"; }

std::filesystem::path level_directory(const std::filesystem::path& model, int level) { return levels_directory(model) / std::to_string(level); }

}  // namespace lumitexel
