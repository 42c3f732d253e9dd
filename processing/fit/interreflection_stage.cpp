#include "processing/fit/interreflection_stage.h"

#include <algorithm>
#include <cmath>

#include "processing/interreflection/indirect_bound.h"

namespace lumitexel {
namespace {

constexpr double kCanMatter = 0.02;     // of a lamp's light on a surface that faces it: under what calibration and meshes leave uncertain
constexpr double kFewestOfAll = 0.005;  // of the lumitexels: a crease or two is not worth another fit
constexpr double kNewEnough = 0.005;    // rms change of the samples followed over their rms: less changes no fit

// Of the way from what was taken out before. A model from which too little was taken is too bright, sends too much, and after that too much is taken: in a
// bowl of albedo 0.7 whole steps go round for ever, half ones arrive.
constexpr float kLaterStep = 0.5f;

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
    taken_.reflectance.emplace_back(tile.reflectance.size(), 0.0f);
  }
}

bool IndirectRemoval::can_matter() const {
  return static_cast<double>(summary_.concerned) > kFewestOfAll * static_cast<double>(bound_.size());
}

bool IndirectRemoval::remove(const Model& model, FitStage stage) {
  IndirectLight found = indirect_light(session_, lumitexels_, wanted_, model, stage, options_.light);
  const float step = summary_.change.empty() ? 1.0f : kLaterStep;
  double change = 0.0, all = 0.0, light = 0.0, indirect = 0.0;
  for (std::size_t t = 0; t < measured_.size(); ++t) {
    LumitexelTile& tile = lumitexels_.tiles[t];
    for (std::size_t k = 0; k < measured_[t].size(); ++k) {
      const float before = taken_.reflectance[t][k];
      const float take = before + step * (found.reflectance[t][k] - before);
      if (take != 0.0f || before != 0.0f) {
        change += square(static_cast<double>(found.reflectance[t][k] - before));
        all += square(static_cast<double>(measured_[t][k]));
        light += static_cast<double>(measured_[t][k]);
        indirect += static_cast<double>(take);
      }
      tile.reflectance[k] = measured_[t][k] - take;
      tile.variance[k] = measured_variance_[t][k] + found.variance[t][k];
      found.reflectance[t][k] = take;
    }
  }
  taken_ = std::move(found);
  const double relative = all > 0.0 ? std::sqrt(change / all) : 0.0;
  summary_.change.push_back(relative);
  summary_.share = light > 0.0 ? indirect / light : 0.0;
  summary_.samples = taken_.samples;
  summary_.dropped_paths += taken_.dropped_paths;
  return relative > kNewEnough;
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
        indirect += static_cast<double>(taken_.reflectance[t][s]);
      }
      texel[1] = light > 0.0 ? static_cast<float>(std::clamp(indirect / light, 0.0, 1.0)) : 0.0f;
    }
  }
  return result;
}

}  // namespace lumitexel
