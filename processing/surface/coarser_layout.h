// The layout of a coarser level of a model's maps: one texel for 2^level x 2^level of the model's own.
#pragma once

#include <utility>
#include <vector>

#include "processing/surface/mesh.h"

namespace lumitexel {

struct CoarserLayout {
  Mesh mesh;  // the model's, with texture coordinates into the coarser atlas
  int width = 0, height = 0;
  // Texels of the model that lie on its surface, ascending, and the coarser texel each is a part of.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> parts;
};

// repack: every chart is scaled and packed anew with a gutter, so that coarser texels never mix charts. Without it texture coordinates stay
// as they are, bit for bit, and charts that share a coarser texel share its content. Charts without area, where nobody saw the
// surface, look up texel (0, 0), as in the model. Throws Error as pack_rectangles does.
CoarserLayout coarser_layout(const Mesh& mesh, int width, int height, int level, bool repack);

}  // namespace lumitexel
