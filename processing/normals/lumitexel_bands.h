// A sample of the surface whose lumitexels still have their neighbours: bands of rows of the atlas.
#pragma once

#include <vector>

#include "processing/surface/lumitexel.h"

namespace lumitexel {

struct LumitexelBands {
  LumitexelSet set;
  std::vector<std::size_t> lumitexel;  // of each in `set`: its number in the whole
  std::vector<std::uint32_t> block;    // and that of its block of 32 by 32 texels of the atlas
};

// At most about `wanted` lumitexels, in bands of 32 rows evenly over the atlas; all of them where there are no more.
LumitexelBands lumitexel_bands(const LumitexelSet& lumitexels, int atlas_width, std::size_t wanted);

}  // namespace lumitexel
