// A flat field's mean over cells of the picture, per colour: what is fitted instead of millions of pixels.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct FlatCell {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // mean place of its samples
  double value = 0, sigma = 0;
  int level = 0;  // which colour of which flat
  int column = 0, row = 0;
};

// About `across` cells along the longer side. Cells with less than half of their samples usable are left out.
// first_level: level of the first colour; the others follow.
std::vector<FlatCell> flat_cells(const MosaicRadiance& flat, int across, int first_level);

}  // namespace lumitexel
