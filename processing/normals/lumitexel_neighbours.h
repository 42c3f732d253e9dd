// Which lumitexels lie beside each other on the surface: what is known of one says something about the other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "processing/normals/directed_samples.h"

namespace lumitexel {

struct Neighbours {
  std::vector<std::uint32_t> other;        // of lumitexel i: other[first[i]] … other[first[i + 1]], ascending
  std::vector<std::size_t> first{0};

  // Four lumitexels around a corner of the atlas, in turn: a small loop on the surface.
  std::vector<std::array<std::uint32_t, 4>> loop;

  std::size_t count(std::size_t lumitexel) const { return first[lumitexel + 1] - first[lumitexel]; }
};

// Texels beside each other in the atlas, unless a depth edge runs between them; and where a patch ends, the nearest lumitexels of the
// patch beyond. Symmetric: who has a neighbour is its neighbour.
Neighbours lumitexel_neighbours(const DirectedLumitexels& lumitexels, int atlas_width);

}  // namespace lumitexel
