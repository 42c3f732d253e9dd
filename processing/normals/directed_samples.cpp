#include "processing/normals/directed_samples.h"

#include <cmath>
#include <utility>

namespace lumitexel {

DirectedLumitexels::DirectedLumitexels(const CalibratedSession& session, const LumitexelSet& lumitexels, std::vector<bool> used)
    : session_(session), lumitexels_(lumitexels), used_(std::move(used)), size_(lumitexels.size()) {
  for (const View& view : session.views) eyes_.push_back(view.camera_in_world());
}

void DirectedLumitexels::samples_of(std::size_t lumitexel, std::vector<DirectedSample>& out) const {
  out.clear();
  const LumitexelTile& from = tile(lumitexel);
  const std::size_t i = within(lumitexel);
  const auto channels = static_cast<std::size_t>(lumitexels_.channels);
  for (std::size_t s = from.first_sample[i]; s < from.first_sample[i + 1]; ++s) {
    if (!used_.empty() && !used_[from.view[s]]) continue;
    DirectedSample sample;
    bool finite = true;
    for (std::size_t c = 0; c < channels; ++c) {
      sample.observation.reflectance[c] = from.reflectance[s * channels + c];
      sample.observation.variance[c] = from.variance[s * channels + c];
      finite = finite && std::isfinite(sample.observation.reflectance[c]) && std::isfinite(sample.observation.variance[c]);
    }
    if (!finite) continue;
    sample.wi = session_.views[from.view[s]].light.direction_from(from.position[i]);
    sample.wo = (eyes_[from.view[s]] - from.position[i]).normalized();
    out.push_back(sample);
  }
}

}  // namespace lumitexel
