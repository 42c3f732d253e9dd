#include "processing/fit/observe.h"

#include "processing/brdf/reject_samples.h"

namespace lumitexel {

Observations observe(const CalibratedSession& session, const LumitexelSet& lumitexels) {
  Observations result;
  result.channels = lumitexels.channels;
  result.samples.reserve(lumitexels.samples());
  result.view.reserve(lumitexels.samples());
  const auto channels = static_cast<std::size_t>(lumitexels.channels);
  std::vector<Eigen::Vector3d> eyes;
  for (const View& view : session.views) eyes.push_back(view.camera_in_world());
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
        Observation observation;
        const Eigen::Vector3d wi = session.views[tile.view[s]].light.direction_from(tile.position[i]);
        const Eigen::Vector3d wo = (eyes[tile.view[s]] - tile.position[i]).normalized();
        observation.geometry = lobe_geometry(tile.normal[i], wi, wo);
        for (std::size_t c = 0; c < channels; ++c) {
          observation.reflectance[c] = tile.reflectance[s * channels + c];
          observation.variance[c] = tile.variance[s * channels + c];
        }
        result.samples.push_back(observation);
        result.view.push_back(tile.view[s]);
      }
      result.first.push_back(result.samples.size());
    }
  }
  result.rejected = reject_unusable(result);
  return result;
}

}  // namespace lumitexel
