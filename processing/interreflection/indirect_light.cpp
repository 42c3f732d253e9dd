#include "processing/interreflection/indirect_light.h"

#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <cmath>

#include "drivers/error.h"
#include "processing/render/path_tracer.h"

namespace lumitexel {
namespace {

constexpr int kReplicates = 2;

using Replicates = std::array<ChannelValues, kReplicates>;  // sums of their paths' radiances

// Paths from the camera through a lumitexel, back to the view's lamp by way of other surfaces.
class Follower {
 public:
  Follower(const ModelSurface& surface, const ReflectingModel& reflecting, const View& view, const IndirectOptions& options)
      : lighting_{{view.light}, nullptr},
        path_(between_surfaces(options.bounces)),
        paths_(options.paths),
        eye_(view.camera_in_world()),
        tracer_(surface, reflecting, lighting_, path_) {}

  static PathOptions between_surfaces(int bounces) {
    PathOptions path;
    path.bounces = bounces;
    path.straight_light = false;
    return path;
  }
  Replicates follow(const Eigen::Vector3d& position, std::size_t lumitexel, std::size_t view, std::size_t& dropped) {
    Replicates sums{};
    const Eigen::Vector3d direction = (position - eye_).normalized();
    for (int path = 0; path < paths_; ++path) {
      const int replicate = path % kReplicates;
      SampleSequence numbers(static_cast<int>(lumitexel), static_cast<int>(view), replicate, static_cast<std::uint32_t>(path / kReplicates));
      const PathSample sample = tracer_.trace(eye_, direction, numbers);
      bool finite = true;
      for (const double value : sample.radiance) finite = finite && std::isfinite(value);
      if (!finite) {
        ++dropped;
        continue;
      }
      ChannelValues& sum = sums[static_cast<std::size_t>(replicate)];
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += sample.radiance[c];
    }
    return sums;
  }

 private:
  Lighting lighting_;
  PathOptions path_;
  int paths_;
  Eigen::Vector3d eye_;
  PathTracer tracer_;
};

// Of one tile, view by view, so that a follower serves many lumitexels.
class TileLight {
 public:
  TileLight(const CalibratedSession& session, const LumitexelTile& tile, int channels, int paths)
      : reflectance(tile.reflectance.size(), 0.0f), variance(tile.reflectance.size(), 0.0f), session_(session), tile_(tile), channels_(static_cast<std::size_t>(channels)), paths_(paths) {}

  void set(std::size_t sample, std::size_t lumitexel, const Replicates& sums) {
    const View& view = session_.views[tile_.view[sample]];
    for (std::size_t c = 0; c < channels_; ++c) {
      const double irradiance = view.light.irradiance(tile_.position[lumitexel], static_cast<int>(c));
      if (!(irradiance > 0.0)) continue;
      const double mean = (sums[0][c] + sums[1][c]) / (paths_ * irradiance), half_difference = (sums[0][c] - sums[1][c]) / (paths_ * irradiance);
      reflectance[sample * channels_ + c] = static_cast<float>(mean);
      variance[sample * channels_ + c] = static_cast<float>(half_difference * half_difference);
    }
  }

  std::vector<float> reflectance, variance;

 private:
  const CalibratedSession& session_;
  const LumitexelTile& tile_;
  std::size_t channels_;
  int paths_;
};

}  // namespace

IndirectLight indirect_light(const CalibratedSession& session, const LumitexelSet& lumitexels, const std::vector<bool>& wanted,
                             const Model& model, FitStage stage, const IndirectOptions& options) {
  if (options.paths < kReplicates || options.paths % kReplicates != 0) {
    throw BadInput("paths a sample (IndirectOptions::paths)", std::to_string(options.paths), "an even number of 2 or more: each of two replicates follows half of them");
  }
  const ModelSurface surface(model);
  const ReflectingModel reflecting(model, stage);
  IndirectLight result;
  result.reflectance.resize(lumitexels.tiles.size());
  result.variance.resize(lumitexels.tiles.size());
  std::atomic<std::size_t> samples = 0, dropped = 0;
  oneapi::tbb::parallel_for(std::size_t{0}, lumitexels.tiles.size(), [&](std::size_t t) {
    const LumitexelTile& tile = lumitexels.tiles[t];
    TileLight light(session, tile, lumitexels.channels, options.paths);
    std::size_t followed = 0, lost = 0;
    for (std::size_t v = 0; v < session.views.size(); ++v) {
      Follower follower(surface, reflecting, session.views[v], options);
      for (std::size_t i = 0; i < tile.size(); ++i) {
        const std::size_t lumitexel = t * LumitexelTile::kCapacity + i;
        if (!wanted[lumitexel]) continue;
        for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
          if (tile.view[s] != v) continue;
          light.set(s, i, follower.follow(tile.position[i], lumitexel, v, lost));
          ++followed;
        }
      }
    }
    result.reflectance[t] = std::move(light.reflectance);
    result.variance[t] = std::move(light.variance);
    samples += followed;
    dropped += lost;
  });
  result.samples = samples;
  result.dropped_paths = dropped;
  return result;
}

}  // namespace lumitexel
