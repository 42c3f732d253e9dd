#include "processing/brdf/reject_samples.h"

#include <cmath>

namespace lumitexel {
namespace {

bool all_finite(const Observation& sample, std::size_t channels) {
  const LobeGeometry& g = sample.geometry;
  for (const double number : {g.cos_i, g.cos_o, g.mirror_gap, g.retro_gap, g.across2}) {
    if (!std::isfinite(number)) return false;
  }
  for (std::size_t c = 0; c < channels; ++c) {
    if (!std::isfinite(sample.reflectance[c]) || !std::isfinite(sample.variance[c]) || sample.variance[c] < 0.0f) return false;
  }
  return true;
}

}  // namespace

RejectedSamples reject_unusable(Observations& observations) {
  RejectedSamples rejected;
  const auto channels = static_cast<std::size_t>(observations.channels);
  std::size_t kept = 0, begin = 0;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    const std::size_t end = observations.first[i + 1];
    for (std::size_t s = begin; s < end; ++s) {
      const Observation& sample = observations.samples[s];
      if (!all_finite(sample, channels)) ++rejected.not_finite;
      else if (sample.geometry.cos_i <= 0.0 || sample.geometry.cos_o <= 0.0) ++rejected.below_surface;
      else {
        observations.samples[kept] = sample;
        if (!observations.view.empty()) observations.view[kept] = observations.view[s];
        ++kept;
      }
    }
    begin = end;
    observations.first[i + 1] = kept;
  }
  observations.samples.resize(kept);
  if (!observations.view.empty()) observations.view.resize(kept);
  return rejected;
}

}  // namespace lumitexel
