#include "processing/image/demosaic.h"

#include <tbb/parallel_for.h>

#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

struct Sum {
  double value = 0, variance = 0;
  int count = 0;
  std::uint8_t any = 0, all = 0xff;

  void add(const MosaicRadiance& m, std::size_t i) {
    value += m.value[i];
    variance += m.variance[i];
    any |= m.flags[i];
    all &= m.flags[i];
    ++count;
  }
};

// The pixels of channel c at distance exactly `reach` (in rows or columns) and nothing defective, unless asked for.
Sum gather(const MosaicRadiance& m, int x, int y, int c, int reach, bool defective_too) {
  Sum sum;
  for (int dy = -reach; dy <= reach; dy += reach) {
    for (int dx = -reach; dx <= reach; dx += reach) {
      const int u = x + dx, v = y + dy;
      if ((dx == 0 && dy == 0) || u < 0 || v < 0 || u >= m.width || v >= m.height) continue;
      if (mosaic_channel(m.mosaic, u, v) != c) continue;
      if (!defective_too && (m.flags[m.index(u, v)] & kPixelDefective)) continue;
      sum.add(m, m.index(u, v));
    }
  }
  return sum;
}

Sum samples_for(const MosaicRadiance& m, int x, int y, int c) {
  const std::size_t own = m.index(x, y);
  const bool own_colour = mosaic_channel(m.mosaic, x, y) == c;
  if (own_colour && !(m.flags[own] & kPixelDefective)) {
    Sum sum;
    sum.add(m, own);
    return sum;
  }
  Sum sum = gather(m, x, y, c, 1, false);
  if (sum.count == 0) sum = gather(m, x, y, c, 2, false);  // the nearest of its colour lie two away
  if (sum.count > 0) return sum;
  if (own_colour) {
    sum.add(m, own);
    return sum;
  }
  return gather(m, x, y, c, 1, true);
}

RadianceImage passed_through(const MosaicRadiance& m) {
  RadianceImage image{Image(m.width, m.height, 1), Image(m.width, m.height, 1), m.flags};
  image.radiance.data = m.value;
  image.variance.data = m.variance;
  return image;
}

void demosaic_row(const MosaicRadiance& m, int y, RadianceImage& image) {
  for (int x = 0; x < m.width; ++x) {
    std::uint8_t any = 0, all = 0xff;
    for (int c = 0; c < 3; ++c) {
      const Sum sum = samples_for(m, x, y, c);
      image.radiance.at(x, y, c) = static_cast<float>(sum.value / sum.count);
      image.variance.at(x, y, c) = static_cast<float>(sum.variance / (sum.count * sum.count));
      any |= sum.any;
      all &= sum.all;
    }
    image.flags[m.index(x, y)] = static_cast<std::uint8_t>((any & ~kPixelDark) | (all & kPixelDark));
  }
}

}  // namespace

RadianceImage demosaic(const MosaicRadiance& m) {
  if (m.mosaic == Mosaic::Mono) return passed_through(m);
  RadianceImage image{Image(m.width, m.height, 3), Image(m.width, m.height, 3), {}};
  image.flags.resize(m.value.size());
  tbb::parallel_for(0, m.height, [&](int y) { demosaic_row(m, y, image); });
  return image;
}

}  // namespace lumitexel
