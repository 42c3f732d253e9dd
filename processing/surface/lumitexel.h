// Lumitexels (section 5 of the paper): all that the photographs say about one surface point.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lumitexel {

// Structure of arrays for some 10^4 lumitexels: the unit of threads, and sums over tiles run in tile order, so that
// results do not depend on which thread did which.
struct LumitexelTile {
  static constexpr std::size_t kCapacity = 8192;

  // One entry a lumitexel.
  std::vector<Eigen::Vector3d> position, normal;  // in world; normal of the coarse mesh until a fit has turned it, unit
  std::vector<std::uint32_t> texel;               // atlas index y * width + x
  std::vector<std::uint32_t> first_sample{0};     // samples of i: first_sample[i] … first_sample[i + 1]

  // One entry a sample.
  std::vector<std::uint16_t> view;   // index into the session's views
  std::vector<float> reflectance;    // channels interleaved: r = f * cos_i, 1/sr
  std::vector<float> variance;       // of each r; 0 where unknown

  std::size_t size() const { return position.size(); }
  std::size_t samples() const { return view.size(); }
};

struct LumitexelSet {
  int channels = 0;
  std::vector<LumitexelTile> tiles;

  std::size_t size() const;
  std::size_t samples() const;
};

// What became of a view's look at a lumitexel: a sample, or the first reason against one.
enum class SampleVerdict : std::uint8_t { Used, OutsideFrame, Hidden, InShadow, DepthEdge, ShadowEdge, Grazing, Flagged, Penumbra };

// What was left out, by reason, over all views and lumitexels.
struct RejectionCounts {
  std::int64_t outside_frame = 0, hidden = 0, in_shadow = 0, near_depth_edge = 0, near_shadow_edge = 0, grazing = 0,
               photograph_flag = 0, in_penumbra = 0;
};

}  // namespace lumitexel
