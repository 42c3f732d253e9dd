#include "processing/normals/lumitexel_bands.h"

namespace lumitexel {
namespace {

constexpr std::uint32_t kRows = 32;  // and columns of a block

void copy_lumitexel(const LumitexelTile& from, std::size_t i, std::size_t channels, LumitexelTile& to) {
  const auto first = static_cast<std::ptrdiff_t>(from.first_sample[i]), last = static_cast<std::ptrdiff_t>(from.first_sample[i + 1]);
  const auto stride = static_cast<std::ptrdiff_t>(channels);
  to.position.push_back(from.position[i]);
  to.normal.push_back(from.normal[i]);
  to.texel.push_back(from.texel[i]);
  to.view.insert(to.view.end(), from.view.begin() + first, from.view.begin() + last);
  to.reflectance.insert(to.reflectance.end(), from.reflectance.begin() + stride * first, from.reflectance.begin() + stride * last);
  to.variance.insert(to.variance.end(), from.variance.begin() + stride * first, from.variance.begin() + stride * last);
  to.first_sample.push_back(static_cast<std::uint32_t>(to.samples()));
}

}  // namespace

LumitexelBands lumitexel_bands(const LumitexelSet& lumitexels, int atlas_width, std::size_t wanted) {
  const std::size_t every = (lumitexels.size() + wanted - 1) / wanted;
  const auto width = static_cast<std::uint32_t>(atlas_width);
  LumitexelBands bands;
  bands.set.channels = lumitexels.channels;
  std::size_t number = 0;
  for (const LumitexelTile& tile : lumitexels.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i, ++number) {
      const std::uint32_t band = tile.texel[i] / width / kRows;
      if (band % every != 0) continue;
      if (bands.lumitexel.size() % LumitexelTile::kCapacity == 0) bands.set.tiles.emplace_back();
      copy_lumitexel(tile, i, static_cast<std::size_t>(lumitexels.channels), bands.set.tiles.back());
      bands.lumitexel.push_back(number);
      bands.block.push_back(band * (width / kRows + 1) + tile.texel[i] % width / kRows);
    }
  }
  return bands;
}

}  // namespace lumitexel
