#include "processing/report/viewer/light_taken.h"

#include <nlohmann/json.hpp>

#include "processing/fit/taken_light.h"
#include "processing/interreflection/indirect_light.h"

namespace lumitexel {
namespace {

using nlohmann::json;

constexpr std::size_t kFoundShare = 1;  // channel of Model::indirect

// What the fit took from each lumitexel, as a share of its samples.
std::vector<double> taken_shares(const Model& model, const LumitexelSet& set) {
  std::vector<double> shares;
  for (const LumitexelTile& tile : set.tiles) {
    for (const std::uint32_t texel : tile.texel) shares.push_back(static_cast<double>(model.indirect.data[std::size_t{2} * texel + kFoundShare]));
  }
  return shares;
}

struct Taking {
  FitStage stage;     // of the finished model, by which light is predicted
  bool is_fits_own;   // that stage is what the fit predicted it by, and was fitted to samples as photographed
  IndirectOptions light;
};

Taking taking_of(const Model& model) {
  const json record = json::parse(model.provenance_json).value("light_between_surfaces", json::object());
  const json rounds = record.value("rounds_taken", json()), paths = record.value("paths_a_sample", json());
  const bool once = rounds.is_number_integer() ? rounds == 1 : record.value("change_by_round", json::array()).size() == 1;  // models of before rounds were kept
  Taking taking{last_stage(model), has_normals(model) && once, {}};
  if (taking.is_fits_own) taking.stage = has_principal_functions(model) ? FitStage::Pfa : FitStage::Projection;
  taking.light.bounces = model.indirect_bounces;
  if (paths.is_number_integer()) taking.light.paths = paths.get<int>();
  return taking;
}

// Lists of one tile, as its reflectance.
struct TileLists {
  std::vector<float> photographed, light, variance;
};

// share: of each of the tile's lumitexels.
void scale_to_shares(const LumitexelTile& tile, std::size_t channels, const double* share, TileLists& lists) {
  for (std::size_t i = 0; i < tile.size(); ++i) {
    const std::size_t first = tile.first_sample[i] * channels, last = tile.first_sample[i + 1] * channels;
    double measured = 0.0, light = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      measured += static_cast<double>(lists.photographed[k]);
      light += static_cast<double>(lists.light[k]);
    }
    const auto factor = static_cast<float>(light > 0.0 ? share[i] * measured / light : 0.0);
    for (std::size_t k = first; k < last; ++k) {
      lists.light[k] *= factor;
      lists.variance[k] *= factor * factor;
    }
  }
}

// What the finished model was fitted without.
std::vector<float> taken_by_shares(const LumitexelTile& tile, std::size_t channels, const double* share) {
  std::vector<float> taken(tile.reflectance.size());
  for (std::size_t i = 0; i < tile.size(); ++i) {
    for (std::size_t k = tile.first_sample[i] * channels; k < tile.first_sample[i + 1] * channels; ++k) taken[k] = static_cast<float>(share[i]) * tile.reflectance[k];
  }
  return taken;
}

}  // namespace

std::vector<float> take_light_of_fit(const Model& model, const CalibratedSession& session, LumitexelSet& set) {
  std::vector<float> all;
  if (model.indirect_bounces == 0) return all;
  const Taking taking = taking_of(model);
  const std::vector<double> shares = taken_shares(model, set);
  std::vector<bool> wanted;
  for (const double share : shares) wanted.push_back(share > 0.0);
  IndirectLight found = indirect_light(session, set, wanted, model, taking.stage, taking.light);
  const auto channels = static_cast<std::size_t>(set.channels);
  const double* share = shares.data();
  for (std::size_t t = 0; t < set.tiles.size(); ++t) {
    LumitexelTile& tile = set.tiles[t];
    TileLists lists{tile.reflectance, std::move(found.reflectance[t]), std::move(found.variance[t])};
    const std::vector<float> before = taking.is_fits_own ? std::vector<float>(tile.reflectance.size(), 0.0f) : taken_by_shares(tile, channels, share);
    scale_to_take(tile, set.channels, lists.photographed, before, lists.light, lists.variance);
    scale_to_shares(tile, channels, share, lists);
    const std::vector<float> photographed_variance = tile.variance;
    for (std::size_t k = 0; k < lists.light.size(); ++k) {
      tile.reflectance[k] -= lists.light[k];
      tile.variance[k] += lists.variance[k];
    }
    even_out_variance(photographed_variance, set.channels, tile);
    all.insert(all.end(), lists.light.begin(), lists.light.end());
    share += tile.size();
  }
  return all;
}

}  // namespace lumitexel
