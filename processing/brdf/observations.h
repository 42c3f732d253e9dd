// Lumitexels as the fits see them: per sample the two directions, reduced to what an isotropic BRDF depends on, and
// the measured reflectance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "processing/brdf/brdf.h"

namespace lumitexel {

struct Observation {
  LobeGeometry geometry;
  std::array<float, kMaxChannels> reflectance{};  // r = f * cos_i, 1/sr
  std::array<float, kMaxChannels> variance{};     // of each r from the photograph's noise; 0 where unknown
};

// Samples that did not pass the gate (reject_samples.h), by reason.
struct RejectedSamples {
  std::size_t not_finite = 0, below_surface = 0;
};

struct Observations {
  int channels = 0;
  std::vector<Observation> samples;
  std::vector<std::size_t> first{0};  // samples of lumitexel i: first[i] … first[i + 1]
  std::vector<std::uint16_t> view;    // of each sample, an index into the session's views; empty where nobody asks for it
  RejectedSamples rejected;

  std::size_t lumitexels() const { return first.size() - 1; }
  std::span<const Observation> of(std::size_t lumitexel) const {
    return {samples.data() + first[lumitexel], first[lumitexel + 1] - first[lumitexel]};
  }
};

// A sample and how much it counts in a fit: the share of its lumitexel that belongs to the material, 0 … 1.
struct FitSample {
  const Observation* observation = nullptr;
  double share = 1;
  std::uint32_t lumitexel = 0;  // samples of one lumitexel stand together
  std::uint16_t view = 0;       // photograph, as in Observations; all 0 where nobody knows
};
using FitSamples = std::span<const FitSample>;

// r = f * cos_i that the BRDF predicts: in channel c, and in all channels.
inline double predicted_reflectance(const Brdf& brdf, int c, const LobeGeometry& geometry) {
  return evaluate(brdf, c, geometry) * geometry.cos_i;
}
inline ChannelValues predicted_reflectance(const Brdf& brdf, const LobeGeometry& geometry) {
  ChannelValues values = evaluate(brdf, geometry);
  for (double& value : values) value *= geometry.cos_i;
  return values;
}

}  // namespace lumitexel
