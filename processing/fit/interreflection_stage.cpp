#include "processing/fit/interreflection_stage.h"

#include <algorithm>
#include <cmath>

#include "processing/fit/taken_light.h"
#include "processing/interreflection/indirect_bound.h"

namespace lumitexel {
namespace {

constexpr double kCanMatter = 0.02;     // of a lamp's light on a surface that faces it: under what calibration and meshes leave uncertain
constexpr double kFewestOfAll = 0.005;  // of the lumitexels: a crease or two is not worth another fit
constexpr double kNewEnough = 0.005;    // rms change of the samples followed over their rms: less changes no fit

double square(double x) { return x * x; }

}  // namespace

IndirectRemoval::IndirectRemoval(const CalibratedSession& session, LumitexelSet& lumitexels, const RayScene& scene, const Model& model,
                                 const InterreflectionOptions& options)
    : session_(session), lumitexels_(lumitexels), options_(options) {
  const std::vector<float> albedo = triangle_albedos(model);
  summary_.albedo = static_cast<double>(*std::max_element(albedo.begin(), albedo.end()));
  bound_ = indirect_bounds(lumitexels, session.mesh, scene, albedo);
  wanted_.resize(bound_.size());
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    wanted_[i] = static_cast<double>(bound_[i]) > kCanMatter;
    summary_.concerned += wanted_[i];
    summary_.largest_bound = std::max(summary_.largest_bound, static_cast<double>(bound_[i]));
  }
  if (!can_matter()) return;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    measured_.push_back(tile.reflectance);
    measured_variance_.push_back(tile.variance);
    taken_.emplace_back(tile.reflectance.size(), 0.0f);
  }
}

bool IndirectRemoval::can_matter() const {
  return static_cast<double>(summary_.concerned) > kFewestOfAll * static_cast<double>(bound_.size());
}

bool IndirectRemoval::remove(const Model& model, FitStage stage) {
  IndirectLight found = indirect_light(session_, lumitexels_, wanted_, model, stage, options_.light);
  for (std::size_t t = 0; t < measured_.size(); ++t) {
    scale_to_take(lumitexels_.tiles[t], lumitexels_.channels, measured_[t], taken_[t], found.reflectance[t], found.variance[t]);
  }
  double change = 0.0, all = 0.0, light = 0.0, indirect = 0.0;
  std::size_t lumitexel = 0;
  for (std::size_t t = 0; t < measured_.size(); ++t) {
    const LumitexelTile& tile = lumitexels_.tiles[t];
    const auto channels = static_cast<std::size_t>(lumitexels_.channels);
    for (std::size_t i = 0; i < tile.size(); ++i, ++lumitexel) {
      if (!wanted_[lumitexel]) continue;
      for (std::size_t k = tile.first_sample[i] * channels; k < tile.first_sample[i + 1] * channels; ++k) {
        change += square(static_cast<double>(found.reflectance[t][k] - taken_[t][k]));
        all += square(static_cast<double>(measured_[t][k]));
        light += static_cast<double>(measured_[t][k]);
        indirect += static_cast<double>(found.reflectance[t][k]);
      }
    }
  }
  const double relative = all > 0.0 ? std::sqrt(change / all) : 0.0;
  summary_.change.push_back(relative);
  summary_.samples = found.samples;
  summary_.dropped_paths += found.dropped_paths;
  if (!(relative > kNewEnough)) return false;
  summary_.share = light > 0.0 ? indirect / light : 0.0;
  for (std::size_t t = 0; t < measured_.size(); ++t) {
    LumitexelTile& tile = lumitexels_.tiles[t];
    for (std::size_t k = 0; k < measured_[t].size(); ++k) {
      tile.reflectance[k] = measured_[t][k] - found.reflectance[t][k];
      tile.variance[k] = measured_variance_[t][k] + found.variance[t][k];
    }
  }
  taken_ = std::move(found.reflectance);
  ++summary_.rounds_taken;
  return true;
}

void IndirectRemoval::even_out_variance() {
  for (std::size_t t = 0; t < measured_.size(); ++t) lumitexel::even_out_variance(measured_variance_[t], lumitexels_.channels, lumitexels_.tiles[t]);
}

void IndirectRemoval::put_back() {
  for (std::size_t t = 0; t < measured_.size(); ++t) {
    lumitexels_.tiles[t].reflectance = measured_[t];
    lumitexels_.tiles[t].variance = measured_variance_[t];
    std::fill(taken_[t].begin(), taken_[t].end(), 0.0f);
  }
  summary_.share = 0.0;
  summary_.rounds_taken = 0;
}

Image IndirectRemoval::map(int width, int height) const {
  Image result(width, height, 2);
  std::size_t i = 0;
  for (std::size_t t = 0; t < lumitexels_.tiles.size(); ++t) {
    const LumitexelTile& tile = lumitexels_.tiles[t];
    const auto channels = static_cast<std::size_t>(lumitexels_.channels);
    for (std::size_t k = 0; k < tile.size(); ++k, ++i) {
      float* texel = &result.data[std::size_t{2} * tile.texel[k]];
      texel[0] = bound_[i];
      double light = 0.0, indirect = 0.0;
      for (std::size_t s = tile.first_sample[k] * channels; !measured_.empty() && s < tile.first_sample[k + 1] * channels; ++s) {
        light += static_cast<double>(measured_[t][s]);
        indirect += static_cast<double>(taken_[t][s]);
      }
      texel[1] = light > 0.0 ? static_cast<float>(std::clamp(indirect / light, 0.0, 1.0)) : 0.0f;
    }
  }
  return result;
}

}  // namespace lumitexel
