#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "processing/fit/fill_atlas.h"
#include "processing/fit/mip_levels.h"
#include "processing/fit/observe.h"
#include "processing/fit/reflectance_stage.h"
#include "processing/interreflection/indirect_light.h"
#include "processing/normals/fit_normals.h"
#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kMeanNormalSigma_rad = 0.03;  // of a mean of fitted normals, per axis: about the sigmas that fits state on O
constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

struct ViewSum {
  std::size_t parts = 0;
  std::array<double, kMaxChannels> reflectance{}, variance{};
};

struct Gathering {  // of one coarser texel
  std::size_t parts = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  std::map<std::uint16_t, ViewSum> views;
};

void add_part(const LumitexelTile& tile, std::size_t i, std::size_t channels, Gathering& into) {
  ++into.parts;
  into.position += tile.position[i];
  into.normal += tile.normal[i];
  for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
    ViewSum& view = into.views[tile.view[s]];
    ++view.parts;
    for (std::size_t c = 0; c < channels; ++c) {
      view.reflectance[c] += static_cast<double>(tile.reflectance[s * channels + c]);
      view.variance[c] += static_cast<double>(tile.variance[s * channels + c]);
    }
  }
}

void append(const Gathering& from, std::uint32_t texel, LumitexelSet& set) {
  if (set.tiles.empty() || set.tiles.back().size() == LumitexelTile::kCapacity) set.tiles.emplace_back();
  LumitexelTile& tile = set.tiles.back();
  tile.position.push_back(from.position / static_cast<double>(from.parts));
  tile.normal.push_back(from.normal.normalized());
  tile.texel.push_back(texel);
  for (const auto& [view, sum] : from.views) {
    if (2 * sum.parts < from.parts) continue;
    tile.view.push_back(view);
    const auto parts = static_cast<double>(sum.parts);
    for (std::size_t c = 0; c < static_cast<std::size_t>(set.channels); ++c) {
      tile.reflectance.push_back(static_cast<float>(sum.reflectance[c] / parts));
      tile.variance.push_back(static_cast<float>(sum.variance[c] / (parts * parts)));
    }
  }
  tile.first_sample.push_back(static_cast<std::uint32_t>(tile.samples()));
}

std::vector<int> labels_of(const LumitexelSet& set, const Model& averaged) {
  std::vector<int> labels;
  for (const LumitexelTile& tile : set.tiles) {
    for (const std::uint32_t texel : tile.texel) labels.push_back(std::max<int>(0, averaged.material[texel]));
  }
  return labels;
}

// Light between surfaces, as the model sends it: the texels' weights, which levels mix the same, were fitted without it.
void take_out_indirect(const CalibratedSession& session, const Model& model, LumitexelSet& set) {
  IndirectOptions options;
  options.bounces = model.indirect_bounces;
  const IndirectLight light = indirect_light(session, set, std::vector<bool>(set.size(), true), model, last_stage(model), options);
  for (std::size_t t = 0; t < set.tiles.size(); ++t) {
    for (std::size_t k = 0; k < set.tiles[t].reflectance.size(); ++k) set.tiles[t].reflectance[k] -= light.reflectance[t][k];
  }
}

// The means of the model's normals, where the texels have some.
void turn_to(const Model& averaged, LumitexelSet& set) {
  for (LumitexelTile& tile : set.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const float* n = &averaged.normal.data[3 * static_cast<std::size_t>(tile.texel[i])];
      const Eigen::Vector3d normal = Eigen::Vector3f(n[0], n[1], n[2]).cast<double>();
      if (normal.norm() > 0.5) tile.normal[i] = normal.normalized();
    }
  }
}

// From the means of the model's normals, which are far nearer than the mesh's.
void fit_level_normals(const CalibratedSession& session, const Model& model, const Model& averaged, const std::vector<int>& label,
                       double median, LumitexelSet& set) {
  turn_to(averaged, set);
  const DirectedLumitexels directed(session, set);
  NormalFitOptions options;
  options.prior.coarse_sigma_rad = kMeanNormalSigma_rad;
  const std::vector<Eigen::Vector3d> normals = fit_normals(directed, lumitexel_neighbours(directed, averaged.width), bases_of(model), label, median, options, Uncertainty::None).normal;
  turn(normals, set);
}

std::vector<TexelWeights> level_weights(const Model& model, const Observations& observations, const std::vector<int>& label, const ErrorModel& error) {
  std::vector<TexelWeights> weights(label.size());
  for (std::size_t j = 0; j < model.materials.size(); ++j) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < label.size(); ++i) {
      if (label[i] == static_cast<int>(j)) members.push_back(i);
    }
    const ModelMaterial& material = model.materials[j];
    const TexelBasis basis(material.basis, material.brdf, error);
    const TexelPrior prior = choose_prior(observations, members, basis).prior;
    oneapi::tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
      weights[members[k]] = project_texel(observations.of(members[k]), basis, prior);
    });
  }
  return weights;
}

}  // namespace

LumitexelSet texel_lumitexels(const Model& model, const CalibratedSession& session, Progress& progress) {
  Atlas atlas;
  atlas.width = model.width;
  atlas.height = model.height;
  atlas.mesh = model.mesh;
  atlas.patch_of_triangle.assign(model.mesh.triangles.size(), -1);
  atlas.at_texel.assign(model.mesh.triangles.size(), 1);
  atlas.sites = layout_sites(model.mesh, model.width, model.height).sites;
  const RayScene scene(session.mesh);
  return gather_lumitexels(session, atlas, scene, progress).set;
}

LumitexelSet coarser_lumitexels(const LumitexelSet& parts, const CoarserLayout& layout) {
  std::vector<std::size_t> coarser_of;  // by the model's texel, as far as there are parts
  for (const auto& [texel, coarser] : layout.parts) {
    if (coarser_of.size() <= texel) coarser_of.resize(texel + 1, kNowhere);
    coarser_of[texel] = coarser;
  }
  std::map<std::uint32_t, Gathering> gathered;
  for (const LumitexelTile& tile : parts.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile.texel[i] >= coarser_of.size() || coarser_of[tile.texel[i]] == kNowhere) continue;
      add_part(tile, i, static_cast<std::size_t>(parts.channels), gathered[static_cast<std::uint32_t>(coarser_of[tile.texel[i]])]);
    }
  }
  LumitexelSet set;
  set.channels = parts.channels;
  for (const auto& [texel, sums] : gathered) append(sums, texel, set);
  return set;
}

Model refitted_level(const Model& model, const Model& averaged, const LumitexelSet& fine, const CalibratedSession& session, int level) {
  const CoarserLayout layout = level_layout(model, level);
  LumitexelSet set = coarser_lumitexels(fine, layout);
  if (model.indirect_bounces > 0) take_out_indirect(session, model, set);
  const std::vector<int> label = labels_of(set, averaged);
  Observations observations = observe(session, set);
  const double median = median_reflectance(observations);
  if (has_normals(model)) {
    fit_level_normals(session, model, averaged, label, median, set);
    observations = observe(session, set);
  }
  const ErrorModel error = error_model(observations, {});
  Model result;
  result.channels = model.channels;
  result.single = model.single;
  for (const ModelMaterial& material : model.materials) result.materials.push_back({material.brdf, material.basis, {}});
  Atlas atlas;
  atlas.width = layout.width;
  atlas.height = layout.height;
  atlas.mesh = layout.mesh;
  // A corner that holds no lumitexel of its own is the one that unseen surface looks up.
  if (averaged.samples.data[0] > 0.0f || averaged.material[0] == Model::kNoMaterial) atlas.unseen_texels.clear();
  fill_atlas(atlas, set, label, level_weights(model, observations, label, error), {}, result);
  // Surface that no view saw, farther from any lumitexel than holes are filled.
  for (std::size_t t = 0; t < result.material.size(); ++t) {
    if (result.material[t] != Model::kNoMaterial || averaged.material[t] == Model::kNoMaterial) continue;
    result.material[t] = averaged.material[t];
    result.weights.data[t * static_cast<std::size_t>(result.weights.channels)] = 1.0f;
    result.uncertainty.data[t] = 1.0f;
  }
  result.indirect_bounces = averaged.indirect_bounces;
  result.indirect = averaged.indirect;
  auto provenance = nlohmann::json::parse(averaged.provenance_json);
  provenance["way"] = "refitted";
  result.provenance_json = provenance.dump();
  return result;
}

}  // namespace lumitexel
