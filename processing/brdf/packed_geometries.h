// Geometries of many samples as arrays of floats: 28 bytes a sample, and fit for wide registers.
//
// The two gaps are kept as float plus rest, 48 bits: what an aim makes of them is a difference from one, and a float alone would lose
// the digits of a small base (lafortune_base.h). A sample whose light or view is not above the surface has cos_i 0.
#pragma once

#include <cstddef>
#include <vector>

#include "processing/brdf/lobe_geometry.h"

namespace lumitexel {

struct PackedGeometries {
  std::vector<float> cos_i, cos_o, mirror_gap, mirror_rest, retro_gap, retro_rest, across2;

  std::size_t size() const { return cos_i.size(); }
  void reserve(std::size_t count);
  void add(const LobeGeometry& geometry);
};

}  // namespace lumitexel
