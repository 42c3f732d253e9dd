#include "processing/calibration/lens/flat_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "processing/image/linear_sensor.h"

namespace lumitexel {

std::vector<FlatCell> flat_cells(const MosaicRadiance& flat, int across, int first_level) {
  const int edge =
      2 * std::max(1, std::max(flat.width, flat.height) / (2 * across));  // even: every cell has every colour
  const int colours = mosaic_channels(flat.mosaic);
  std::vector<FlatCell> cells;
  for (int top = 0; top + edge <= flat.height; top += edge) {
    for (int left = 0; left + edge <= flat.width; left += edge) {
      std::array<FlatCell, 3> sums{};
      std::array<int, 3> used{}, all{};
      for (int y = top; y < top + edge; ++y) {
        for (int x = left; x < left + edge; ++x) {
          const auto c = static_cast<std::size_t>(mosaic_channel(flat.mosaic, x, y));
          const std::size_t i = flat.index(x, y);
          ++all[c];
          if ((flat.flags[i] & kUnusablePixel) || !std::isfinite(flat.value[i])) continue;
          sums[c].value += flat.value[i];
          sums[c].sigma += flat.variance[i];
          sums[c].pixel += Eigen::Vector2d(x + 0.5, y + 0.5);
          ++used[c];
        }
      }
      for (std::size_t c = 0; c < static_cast<std::size_t>(colours); ++c) {
        if (2 * used[c] < all[c] || used[c] == 0) continue;
        const double n = used[c];
        cells.push_back({sums[c].pixel / n, sums[c].value / n, std::sqrt(sums[c].sigma) / n,
                         first_level + static_cast<int>(c), left / edge, top / edge});
      }
    }
  }
  return cells;
}

}  // namespace lumitexel
